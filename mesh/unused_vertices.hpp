// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::mesh {

/// Removes the vertices that no triangle uses, and renumbers the others in their order. Unused vertices would move a
/// scene's origin without being visible. Returns the old indices of the remaining vertices, in order; empty if all
/// remain.
std::vector<std::uint32_t> drop_unused_vertices(TriangleSoup& soup);

}  // namespace penumbra::mesh
