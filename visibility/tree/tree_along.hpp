// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/tree/triangle_tree.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>

namespace penumbra::visibility {

/// Boxes near triangles of a tree. Functions are called on all cores, `triangle` several times for each box.
struct BoxesNear {
  std::size_t count = 0;
  std::function<Bounds(std::size_t)> box;
  std::function<std::uint32_t(std::size_t)> triangle;  ///< a triangle in one of the tree's leaves
};

/// Makes a tree over boxes (of edges, for example), many times faster than without a guide: down to a few dozen boxes
/// it divides them as `guide` divides triangles, with bounds of the boxes themselves; below that in halves along the
/// longest side, so that leaves are full. Linear in boxes and guide; in parallel, and independent of the number of
/// threads.
TriangleTree make_tree_along(const TriangleTree& guide, const BoxesNear& boxes);

}  // namespace penumbra::visibility
