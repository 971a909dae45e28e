// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/vectors/light_grid.hpp"
#include "engines/vectors/table.hpp"
#include "engines/vectors/trees.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

/// Edges and triangles that may affect a cluster of view samples.
namespace penumbra::vectors {

/// The columns of an EdgeTable. One row is one edge, from A to B, with up to two triangles; all positions are relative
/// to the middle of the cluster that the edge was found for, in the grid's axes (across, along, axis), n in world axes.
///
///   | column | meaning |
///   | --- | --- |
///   | kAx, kAy, kAh | A: across, along, height |
///   | kBx, kBy, kBh | B: across, along, height |
///   | kNormalIX, Y, Z | normal n of triangle I (I = 1, 2) |
///   | kOffsetI | n · a for a point a of its plane |
///   | kOffsetErrorI | error of n · p − kOffsetI for any p of the cluster; −1: there is no triangle I |
///   | kPlaneI | the plane's index, as bits |
///   | kFar | the larger of the two ends' distances from the cluster's middle |
///   | kEdgeSlot | leaf · kWide + lane in the hierarchy, as bits |
enum EdgeField : std::size_t {
  kAx,
  kAy,
  kAh,
  kBx,
  kBy,
  kBh,
  kNormal1X,
  kNormal1Y,
  kNormal1Z,
  kOffset1,
  kOffsetError1,
  kPlane1,
  kNormal2X,
  kNormal2Y,
  kNormal2Z,
  kOffset2,
  kOffsetError2,
  kPlane2,
  kFar,
  kEdgeSlot,
  kEdgeFields
};
using EdgeTable = Table<kEdgeFields>;

/// The columns of a TriangleTable, with the conventions of EdgeField: three corners (across, along, height each), the
/// plane's index as bits, the largest of the corners' distances from the cluster's middle, leaf · kWide + lane as bits.
enum TriangleField : std::size_t {
  kCornerA,
  kCornerB = 3,
  kCornerC = 6,
  kTrianglePlane = 9,
  kTriangleFar,
  kTriangleSlot,
  kTriangleFields
};
using TriangleTable = Table<kTriangleFields>;

struct EdgeInput {
  const LightGrid& grid;
  const WideEdgeTree& tree;
  const Cluster& cluster;
  /// The cluster's only view sample, which is its middle, if edges that it sees between two rows of light samples can
  /// be skipped; else null.
  const ClusterSample* alone = nullptr;
};
struct TriangleInput {
  const LightGrid& grid;
  const WideTriangleTree& tree;
  const Cluster& cluster;
  const Shaft& shaft;  ///< one of the cluster's shafts
  std::uint32_t outside_of =
      0;  ///< bits (WideTriangles::closed) of closed parts whose triangles can be skipped if seen from outside
};
/// Finds roots for the traversals of the cluster's sub-clusters: subtrees (TriangleTree::Child::reference) that contain
/// everything these can find. `edges` is scratch for testing leaves.
void find_edge_roots(const EdgeInput& input, EdgeTable& edges, std::vector<std::uint32_t>& roots);
/// Finds edges that meet the shaft to the light and that may be silhouettes as seen from the cluster.
void find_edges(const EdgeInput& input, const std::vector<std::uint32_t>& roots, std::vector<std::uint32_t>& stack,
                EdgeTable& edges);
/// Continues find_edges, but stops at more than `most` edges; returns whether all were found. On false the stack holds
/// the remaining subtrees.
bool find_more_edges(const EdgeInput& input, std::vector<std::uint32_t>& stack, EdgeTable& edges, std::size_t most);
/// Returns the number of leaves that find_edges would visit.
std::size_t count_edge_leaves(const EdgeInput& input, const std::vector<std::uint32_t>& roots,
                              std::vector<std::uint32_t>& stack);
/// Narrows the roots of a cluster to those of a sub-cluster.
void narrow_edge_roots(const EdgeInput& input, std::vector<std::uint32_t>& roots);
void narrow_triangle_roots(const TriangleInput& input, std::vector<std::uint32_t>& roots);
/// Finds roots for the sub-clusters' traversals for triangles in `shaft`, as find_edge_roots does for edges.
void find_triangle_roots(const TriangleInput& input, TriangleTable& triangles, std::vector<std::uint32_t>& roots);
/// Returns the number of leaves that the shaft meets, at most `most`.
std::size_t count_leaves(const TriangleInput& input, const std::vector<std::uint32_t>& roots,
                         std::vector<std::uint32_t>& stack, std::size_t most);
void find_triangles(const TriangleInput& input, const std::vector<std::uint32_t>& roots,
                    std::vector<std::uint32_t>& stack, TriangleTable& triangles);

}  // namespace penumbra::vectors
