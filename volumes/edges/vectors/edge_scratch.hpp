#pragma once

#include "volumes/edges/vectors/group.hpp"
#include "volumes/edges/vectors/tables.hpp"

#include <cstdint>
#include <vector>

/// Buffers of one thread of a method of signed edges. Inside volumes/ only.
namespace penumbra::volumes {

/// The walks that list edges and triangles, of a region of view samples and of its clusters.
struct WalkScratch {
  std::vector<std::uint32_t> edge_roots, triangle_roots, stack;
  std::vector<std::uint32_t> narrow_edge_roots, narrow_triangle_roots, probe_stack;  // of view samples alone
  bool dense = false;                                                                // the region (kDense)
  bool alone = false;  // so are the view samples of one of the region's clusters
  std::uint64_t listed = 0, dense_regions = 0, alone_samples = 0;  // counted
};

/// What was listed for a cluster, and what of it matters to a group and to one view sample.
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
