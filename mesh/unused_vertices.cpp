// SPDX-License-Identifier: Apache-2.0
// Removes unused vertices and renumbers the others.

#include "mesh/unused_vertices.hpp"

#include <algorithm>
#include <cstddef>

namespace penumbra::mesh {

std::vector<std::uint32_t> drop_unused_vertices(TriangleSoup& soup) {
  std::vector<std::uint8_t> used(soup.positions.size(), 0);
  for (const Triangle& triangle : soup.triangles) {
    for (const std::uint32_t vertex : triangle) used[vertex] = 1;
  }
  if (std::ranges::all_of(used, [](std::uint8_t is_used) { return is_used != 0; })) return {};
  std::vector<std::uint32_t> new_number(soup.positions.size()), kept;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] == 0) continue;
    new_number[i] = static_cast<std::uint32_t>(kept.size());
    soup.positions[kept.size()] = soup.positions[i];
    kept.push_back(static_cast<std::uint32_t>(i));
  }
  soup.positions.resize(kept.size());
  for (Triangle& triangle : soup.triangles) {
    for (std::uint32_t& vertex : triangle) vertex = new_number[vertex];
  }
  return kept;
}

}  // namespace penumbra::mesh
