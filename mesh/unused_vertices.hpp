#pragma once

#include "mesh/triangle_soup.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::mesh {

/// Takes out the vertices that no triangle uses, and numbers the others anew in their order. They are no part of a
/// scene: they would move its origin without being seen. Returns the old numbers of those that stay, in order; empty
/// where all do.
std::vector<std::uint32_t> drop_unused_vertices(TriangleSoup& soup);

}  // namespace penumbra::mesh
