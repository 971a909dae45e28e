#pragma once

#include "native/frame.hpp"
#include "native/table.hpp"
#include "native/trees.hpp"

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

/// Subtrees (TriangleTree::Child::reference) that hold all that a walk can find.
struct Roots {
  std::vector<std::uint32_t> edges, triangles;
};
struct FindInput {
  const Frame& frame;
  const WideEdgeTree& edges;
  const WideTriangleTree& triangles;
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
/// Where the walks of clusters that are part of this one may begin. The tables are for trying leaves.
void find_roots(const FindInput& input, EdgeTable& edges, TriangleTable& triangles, Roots& roots);
/// Edges that the shaft to the light meets and that may be silhouettes as seen from the cluster; triangles that the
/// shaft to the light's corner meets.
void find(const FindInput& input, const Roots& from, std::vector<std::uint32_t>& stack, EdgeTable& edges,
          TriangleTable& triangles);
/// The same for triangles alone, and any shaft.
void find_triangle_roots(const TriangleInput& input, TriangleTable& triangles, std::vector<std::uint32_t>& roots);
void find_triangles(const TriangleInput& input, const std::vector<std::uint32_t>& roots,
                    std::vector<std::uint32_t>& stack, TriangleTable& triangles);

}  // namespace penumbra::native
