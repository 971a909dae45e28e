#pragma once

#include "visibility/tree/triangle_tree.hpp"

#include <cstdint>
#include <span>

namespace penumbra::visibility {

/// A tree over boxes that lie near triangles of `guide` (edges, each near one of its triangles: `near`, one a box, all
/// of them in the guide's leaves), many times as soon as one that knows nothing: down to a few dozen boxes it divides
/// them as the guide divides triangles, with boxes of its own; below that in halves along the longest side, so that
/// leaves are full. Linear in boxes and the guide; in parallel, the same whatever the number of threads.
TriangleTree make_tree_along(const TriangleTree& guide, std::span<const Bounds> boxes,
                             std::span<const std::uint32_t> near);

}  // namespace penumbra::visibility
