#pragma once

#include "visibility/tree/triangle_tree.hpp"

#include <cstdint>
#include <functional>

/// A hierarchy for the next frame: who hangs below whom stays, boxes are made anew. It holds what a new one holds, so
/// that a walk over it finds the same; how fast depends on how well the old grouping fits.
namespace penumbra::visibility {

/// A refit hierarchy is given up where its cost has grown by this factor since it was built: chosen, so that walks take
/// at most about half as long again.
constexpr double kMostGrowth = 1.5;

/// What a walk by something that touches boxes at random costs (surface area heuristic): the expected number of nodes
/// and leaves, the root's box being touched. Of no area: 0.
double tree_cost(const TriangleTree& tree);

/// Boxes of leaves and nodes from those of the numbers in its leaves. Functions are called on all cores. An empty box
/// (lower above upper) adds nothing; a leaf of such alone gets the root's lower corner. Leaves of which `has_moved` is
/// false keep their boxes.
void refit_tree(TriangleTree& tree, const std::function<Bounds(std::uint32_t)>& box,
                const std::function<bool(std::size_t leaf)>& has_moved);

/// Do its leaves hold the triangles that cast shadow, and no others?
bool holds_casters(const TriangleTree& tree, const SceneFloats& scene);
/// Of a scene whose casters it holds.
void refit_triangle_tree(TriangleTree& tree, const SceneFloats& scene);

}  // namespace penumbra::visibility
