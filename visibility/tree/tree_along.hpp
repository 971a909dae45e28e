#pragma once

#include "visibility/tree/triangle_tree.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>

namespace penumbra::visibility {

/// Boxes near triangles of a tree. Functions are called on all cores, `triangle` more than once a box.
struct BoxesNear {
  std::size_t count = 0;
  std::function<Bounds(std::size_t)> box;
  std::function<std::uint32_t(std::size_t)> triangle;  ///< in one of the tree's leaves
};

/// A tree over boxes (of edges, for example), many times as soon as one that knows nothing: down to some dozens of
/// boxes it divides them as `guide` divides triangles, with boxes of its own; below that in halves along the longest
/// side, so that leaves are full. Linear in boxes and the guide; in parallel, the same whatever the number of threads.
TriangleTree make_tree_along(const TriangleTree& guide, const BoxesNear& boxes);

}  // namespace penumbra::visibility
