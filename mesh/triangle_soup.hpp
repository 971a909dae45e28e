// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::mesh {

using Triangle = std::array<std::uint32_t, 3>;

/// Triangles as read from a file: the default representation, from which nothing is ever dropped silently. Positions
/// may repeat, triangles may be degenerate, doubled, open, non-manifold. Lengths in the file's unit, double precision.
struct TriangleSoup {
  std::vector<glm::dvec3> positions;
  std::vector<Triangle> triangles;         ///< indices into positions, all in range
  std::vector<std::uint32_t> object;       ///< for each triangle, the index of its object
  std::vector<std::uint32_t> source_face;  ///< for each triangle, the face's number in the source file (from 0)
};

}  // namespace penumbra::mesh
