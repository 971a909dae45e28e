// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/import.hpp"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace penumbra::import {

/// A part placed by another part or by the file itself.
struct PlacedPart {
  std::size_t part = 0;  ///< index into the list of parts
  glm::dmat4 placement{1};
};

/// A part: its own triangles, its child parts, or both.
struct AssemblyPart {
  std::string name;  ///< name in messages: "object 3"
  std::vector<glm::dvec3> positions;
  std::vector<mesh::Triangle> triangles;  ///< into `positions`, in range
  std::vector<PlacedPart> children;
  std::vector<std::uint32_t> corners = {};  ///< indices into `positions`, for faces with any number of corners, one
                                            ///< face after the other
  std::vector<std::size_t> face_ends = {};  ///< end of each face in `corners`
};

/// Returns the triangles of all `roots` and of the parts below them, every part as often as it is placed. Parts that
/// are never placed are counted in a note, and so are mirrored ones, whose windings are reversed. Throws InputError if
/// a part contains itself, if a position that a face uses is not finite after placing, or if there are no triangles;
/// `instead` then describes the file's other content.
mesh::ImportedMesh assemble(std::span<const AssemblyPart> parts, std::span<const PlacedPart> roots,
                            const std::string& file, const std::string& instead = "");

}  // namespace penumbra::import
