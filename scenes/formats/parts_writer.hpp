// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace penumbra::scenes {

/// A named, coloured object for display.
struct Part {
  std::string name;
  glm::dvec4 color{1};  ///< linear red, green, blue; opacity
  std::vector<glm::dvec3> positions;
  std::vector<mesh::Triangle> triangles;
  std::vector<std::array<std::uint32_t, 2>> lines;
};

/// Writes parts in the format of the file's extension:
/// - .glb: a node, a mesh and a material for each part (two-sided), under a node that translates by `origin`; positions
///   in float32 relative to it. Lines become line primitives.
/// - .obj: an object for each part, lines as `l`; positions plus origin.
/// - .ply: one mesh with face and edge colours; positions plus origin.
///
/// A part without triangles and lines is left out. Throws UsageError for another extension, ResourceError if the file
/// cannot be written; the file appears whole or not at all.
void write_parts(const std::filesystem::path& file, std::span<const Part> parts, const glm::dvec3& origin);

}  // namespace penumbra::scenes
