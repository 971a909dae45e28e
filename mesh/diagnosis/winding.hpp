#pragma once

#include "mesh/edge_graph.hpp"

#include <cstdint>
#include <span>
#include <vector>

/// Is a soup watertight? Its winding number w(q) = (sum of the triangles' signed solid angles as seen from q) / 4π
/// jumps by integers where q crosses triangles; it is an integer everywhere exactly if the *signed boundary* (each edge
/// with the number of triangles that run along it less those that run against it) is zero as a set of points with
/// multiplicity: Jacobson et al. 2013, "Robust inside-outside segmentation using generalized winding numbers". Ours:
/// the exact decision, without a tolerance and wherever the edges are split.
namespace penumbra::mesh {

/// Which triangles to turn so that neighbours agree: two triangles are neighbours across an edge of exactly these two,
/// if they differ in their third vertex. Each patch of neighbours keeps the winding that most of its triangles have
/// (of equally many, that of the triangle whose sorted corners are first in lexicographic order); a patch that cannot
/// agree (a Möbius strip) keeps them all.
std::vector<bool> turns_to_agree(const MeshView& mesh, const EdgeGraph& graph);

/// Is the signed boundary exactly zero, with the triangles wound as they are, or turned where `turned` says so? (Empty:
/// nowhere.)
bool is_closed(const MeshView& mesh, const EdgeGraph& graph, const std::vector<bool>& turned = {});

}  // namespace penumbra::mesh
