#pragma once

#include "mesh/import.hpp"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace penumbra::mesh {

/// One part of a file, put somewhere by another part or by the file itself.
struct PlacedPart {
  std::size_t part = 0;  ///< a number into the list of parts
  glm::dmat4 placement{1};
};

/// A part has triangles of its own, or other parts, or both.
struct AssemblyPart {
  std::string name;  ///< for messages: "object 3"
  std::vector<glm::dvec3> positions;
  std::vector<Triangle> triangles;  ///< into `positions`, in range
  std::vector<PlacedPart> children;
  std::vector<std::uint32_t> corners = {};  ///< of faces of any number of corners, one after the other, as `triangles`
  std::vector<std::size_t> face_ends = {};  ///< of each of these, in `corners`
};

/// The triangles of all `roots` and what they are made of, every part as often as it is placed. Parts that nothing
/// places are counted in a note, and so are mirrored ones, whose windings are reversed. Throws InputError if a part is
/// made of itself, if a position that a face uses is not finite where it is placed, or if there are no triangles;
/// `instead` says then what there is in their place.
ImportedMesh assemble(std::span<const AssemblyPart> parts, std::span<const PlacedPart> roots, const std::string& file,
                      const std::string& instead = "");

}  // namespace penumbra::mesh
