#pragma once

#include "engines/vectors/frame.hpp"
#include "engines/vectors/table.hpp"
#include "engines/vectors/trees.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

/// Edges and triangles that may matter to a cluster of view samples.
namespace penumbra::native {

/// Of an edge, relative to its cluster: ends in the frame's axes; of its two triangles n, n · anchor, the error of
/// n · p − n · anchor for all of the cluster's p (−1: no triangle), and the plane's number (bits). Then how far its
/// ends are from the cluster's middle.
enum EdgeField : std::size_t {
  kAx,
  kAy,
  kAh,
  kBx,
  kBy,
  kBh,
  kN1x,
  kN1y,
  kN1z,
  kD1,
  kE1,
  kPlane1,
  kN2x,
  kN2y,
  kN2z,
  kD2,
  kE2,
  kPlane2,
  kFar,
  kEdgeSlot,  ///< of the hierarchy's leaves (bits)
  kEdgeFields
};
using EdgeTable = Table<kEdgeFields>;

enum TriangleField : std::size_t {
  kCornerA,
  kCornerB = 3,
  kCornerC = 6,
  kTrianglePlane = 9,
  kTriangleFar,
  kTriangleSlot,  ///< of the hierarchy's leaves (bits)
  kTriangleFields
};
using TriangleTable = Table<kTriangleFields>;

struct EdgeInput {
  const Frame& frame;
  const WideEdgeTree& tree;
  const Cluster& cluster;
};
struct TriangleInput {
  const Frame& frame;
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
/// The same for triangles, and any shaft.
void find_triangle_roots(const TriangleInput& input, TriangleTable& triangles, std::vector<std::uint32_t>& roots);
/// Leaves that the shaft meets, at most `most`.
std::size_t count_leaves(const TriangleInput& input, const std::vector<std::uint32_t>& roots,
                         std::vector<std::uint32_t>& stack, std::size_t most);
void find_triangles(const TriangleInput& input, const std::vector<std::uint32_t>& roots,
                    std::vector<std::uint32_t>& stack, TriangleTable& triangles);

}  // namespace penumbra::native
