// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/edge_graph.hpp"

#include <cstdint>
#include <span>
#include <vector>

/// Watertightness of a soup. Its winding number w(q) = (sum of the triangles' signed solid angles as seen from q) / 4π
/// jumps by integers where q crosses triangles; it is an integer everywhere exactly if the *signed boundary* (each edge
/// with the number of triangles that run along it less those that run against it) is zero as a set of points with
/// multiplicity: Jacobson et al. 2013, "Robust inside-outside segmentation using generalized winding numbers". Added
/// here: the exact decision, without a tolerance and regardless of where edges are split.
namespace penumbra::mesh {

/// Returns the triangles to turn so that neighbours agree: two triangles are neighbours across an edge of exactly these
/// two, if they differ in their third vertex. Each patch of neighbours keeps the winding that most of its triangles
/// have (if equally many, that of the triangle whose sorted corners are first in lexicographic order); a patch that
/// cannot agree (a Möbius strip) keeps all windings.
std::vector<bool> turns_to_agree(const MeshView& mesh, const EdgeGraph& graph);

/// Returns whether the signed boundary is exactly zero, with each triangle reversed if `turned` is true for it (empty:
/// none is).
bool is_closed(const MeshView& mesh, const EdgeGraph& graph, const std::vector<bool>& turned = {});

}  // namespace penumbra::mesh
