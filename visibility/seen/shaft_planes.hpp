// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"
#include "visibility/seen/box_tree.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace penumbra::visibility {

/// The planes around a shaft side by side, for vector units: no point of the shaft has normal · x > most.
struct ShaftPlanes {
  static constexpr std::uint32_t kMost = 64;

  /// More planes than kMost are left out, which makes the shaft larger.
  void add(const glm::dvec3& normal, double farthest) {
    if (count == kMost) return;
    x[count] = normal.x, y[count] = normal.y, z[count] = normal.z;
    most[count++] = farthest;
  }

  alignas(64) std::array<double, kMost> x{}, y{}, z{}, most{};  ///< entries from `count` on are 0, which bounds nothing
  std::uint32_t count = 0;
};

/// Appends the triangles of a mesh that may reach into the shaft, found by the mesh's tree. Both are in the planes'
/// space.
void touched(const BoxTree& tree, const mesh::TriangleSoup& soup, const ShaftPlanes& planes,
             std::vector<std::uint32_t>& triangles);

}  // namespace penumbra::visibility
