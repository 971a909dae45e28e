// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/edges/vectors/group.hpp"
#include "volumes/edges/vectors/tables.hpp"

#include <cstdint>
#include <vector>

/// Buffers of one thread of a method with signed edges. Inside volumes/ only.
namespace penumbra::volumes {

/// Buffers for traversals that list edges and triangles, for a region of view samples and for its clusters.
struct WalkScratch {
  std::vector<std::uint32_t> edge_roots, triangle_roots, stack;
  std::vector<std::uint32_t> narrow_edge_roots, narrow_triangle_roots, probe_stack;  // for single view samples
  // whether the region is dense (kDense)
  bool dense = false;
  bool alone = false;  // the region is dense, and so are the single view samples of one of its clusters
  std::uint64_t listed = 0, dense_regions = 0, alone_samples = 0;  // counters
};

/// Lists of a cluster, and their parts that affect a group and a single view sample.
struct EdgeScratch {
  WalkScratch walk;
  std::vector<ClusterSample> samples;
  EdgeTable edges;
  TriangleTable triangles;
  GroupLists lists;
  CrossingTable crossing;
  Open open;
};

}  // namespace penumbra::volumes
