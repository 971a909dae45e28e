#pragma once

#include "engines/vectors/light_grid.hpp"
#include "engines/vectors/table.hpp"
#include "engines/vectors/trees.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

/// Edges and triangles that may matter to a cluster of view samples.
namespace penumbra::vectors {

/// The columns of an EdgeTable. One row is one edge, from A to B, with up to two triangles; all positions are relative
/// to the middle of the cluster that it was found for, in the grid's axes (across, along, axis), n in world axes.
///
/// | column | meaning |
/// | --- | --- |
/// | kAx, kAy, kAh | A: across, along, height |
/// | kBx, kBy, kBh | B: across, along, height |
/// | kNormalIX, Y, Z | normal n of triangle I (I = 1, 2) |
/// | kOffsetI | n · a for a point a of its plane |
/// | kOffsetErrorI | what n · p − kOffsetI may be off by for any p of the cluster; −1: there is no triangle I |
/// | kPlaneI | the plane's number, as bits |
/// | kFar | the larger of the two ends' distances from the cluster's middle |
/// | kEdgeSlot | leaf · kWide + lane in the hierarchy, as bits |
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

/// The columns of a TriangleTable, likewise: three corners (across, along, height each), the plane's number as bits,
/// the largest of the corners' distances from the cluster's middle, leaf · kWide + lane as bits.
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
  /// The cluster's one view sample, which is its middle, if edges that it sees between two rows of light samples change
  /// nothing; else null.
  const ClusterSample* alone = nullptr;
};
struct TriangleInput {
  const LightGrid& grid;
  const WideTriangleTree& tree;
  const Cluster& cluster;
  const Shaft& shaft;  ///< one of the cluster's
  std::uint32_t outside_of =
      0;  ///< bits (WideTriangles::closed) of which no triangle matters that is seen from outside
};
/// Where the walks of clusters that are part of this one may begin: subtrees (TriangleTree::Child::reference) that hold
/// all that they can find. The table is for trying leaves.
void find_edge_roots(const EdgeInput& input, EdgeTable& edges, std::vector<std::uint32_t>& roots);
/// Edges that the shaft to the light meets and that may be silhouettes as seen from the cluster.
void find_edges(const EdgeInput& input, const std::vector<std::uint32_t>& roots, std::vector<std::uint32_t>& stack,
                EdgeTable& edges);
/// The same, but stops when there are more than `most` edges: returns whether that are all. What the stack holds then
/// is what is left to do.
bool find_more_edges(const EdgeInput& input, std::vector<std::uint32_t>& stack, EdgeTable& edges, std::size_t most);
/// Leaves that find_edges would look at.
std::size_t count_edge_leaves(const EdgeInput& input, const std::vector<std::uint32_t>& roots,
                              std::vector<std::uint32_t>& stack);
/// Roots of walks of clusters that are part of this one, from those of clusters that it is part of.
void narrow_edge_roots(const EdgeInput& input, std::vector<std::uint32_t>& roots);
void narrow_triangle_roots(const TriangleInput& input, std::vector<std::uint32_t>& roots);
/// Where the walks for triangles in `shaft` of clusters that are part of this one may begin, as for edges.
void find_triangle_roots(const TriangleInput& input, TriangleTable& triangles, std::vector<std::uint32_t>& roots);
/// Leaves that the shaft meets, at most `most`.
std::size_t count_leaves(const TriangleInput& input, const std::vector<std::uint32_t>& roots,
                         std::vector<std::uint32_t>& stack, std::size_t most);
void find_triangles(const TriangleInput& input, const std::vector<std::uint32_t>& roots,
                    std::vector<std::uint32_t>& stack, TriangleTable& triangles);

}  // namespace penumbra::vectors
