// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace penumbra::mesh {

/// Returns the representative of i's set. `parent` is a forest of sets: parent[i] == i at representatives. Halves paths
/// during the search, so that later calls are short.
inline std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace penumbra::mesh
