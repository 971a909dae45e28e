// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/tree/triangle_tree.hpp"

#include <cstdint>
#include <functional>

/// Update of a hierarchy for the next frame: its structure stays, its boxes are recomputed. It contains the same
/// triangles as a new one, so that a traversal finds the same; its speed depends on how well the old grouping fits.
namespace penumbra::visibility {

/// A refit hierarchy is rebuilt when its cost has grown by this factor since it was built: chosen so that traversals
/// take at most about 50 % longer.
constexpr double kMostGrowth = 1.5;

/// Returns the cost of a traversal that touches boxes at random (surface area heuristic): the expected number of nodes
/// and leaves, given that the root's box is touched. 0 if there is no area.
double tree_cost(const TriangleTree& tree);

/// Recomputes the boxes of leaves and nodes from those of the indices in its leaves. Functions are called on all cores.
/// An empty box (lower above upper) adds nothing; a leaf with only empty boxes gets the root's lower corner. Leaves for
/// which `has_moved` is false keep their boxes.
void refit_tree(TriangleTree& tree, const std::function<Bounds(std::uint32_t)>& box,
                const std::function<bool(std::size_t leaf)>& has_moved);

/// Returns whether the tree's leaves contain exactly the triangles that cast shadows.
bool holds_casters(const TriangleTree& tree, const SceneFloats& scene);
/// Refits a tree to a scene with the same casters.
void refit_triangle_tree(TriangleTree& tree, const SceneFloats& scene);

}  // namespace penumbra::visibility
