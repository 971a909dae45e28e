// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace penumbra::mesh {

using Color = std::array<std::uint8_t, 3>;  ///< red, green, blue

struct PlyEdge {
  std::uint32_t a = 0, b = 0;  ///< indices into positions
  Color color{};
};

struct PlyMesh {
  std::vector<glm::dvec3> positions;
  std::vector<Triangle> triangles;
  std::vector<Color> triangle_colors;  ///< one for each triangle, or empty
  std::vector<PlyEdge> edges;
};

/// Writes a binary little-endian PLY: vertices in double, faces, and, if there are any, face colours (uchar red, green,
/// blue) and an `edge` element (vertex1, vertex2, red, green, blue). The file appears whole or not at all
/// (base/atomic_file.hpp: ResourceError). Readers that store single precision, such as this project's importer, round
/// the positions.
void write_ply(const std::filesystem::path& path, const PlyMesh& mesh);

}  // namespace penumbra::mesh
