// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <random>
#include <vector>

namespace penumbra::tests {

/// Reorders the triangles; the first `kept` stay where they are.
inline void shuffle_order(mesh::TriangleSoup& soup, std::mt19937& random, std::size_t kept = 0) {
  std::vector<std::size_t> order(soup.triangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin() + static_cast<std::ptrdiff_t>(kept), order.end(), random);
  const mesh::TriangleSoup before = soup;
  for (std::size_t i = 0; i < order.size(); ++i) {
    soup.triangles[i] = before.triangles[order[i]];
    soup.object[i] = before.object[order[i]];
    soup.source_face[i] = before.source_face[order[i]];
  }
}

/// Starts each triangle at another corner, and winds half of them the other way.
inline void shuffle_corners(mesh::TriangleSoup& soup, std::mt19937& random) {
  for (mesh::Triangle& triangle : soup.triangles) std::shuffle(triangle.begin(), triangle.end(), random);
}

}  // namespace penumbra::tests
