// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/edges/vectors/edge_scratch.hpp"
#include "volumes/edges/vectors/group.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// depth-complexity on a processor. Inside volumes/ only.
namespace penumbra::volumes {

/// Buffers of one thread, in addition to EdgeScratch.
struct CountScratch {
  static constexpr std::size_t kFields = 10;
  Table<kFields> edges;         ///< those in EdgeScratch::crossing; columns are defined in count_samples.cpp
  std::vector<float> counters;  ///< for each slot (LightTiles)
  struct Near {
    std::uint32_t edge, slot;
  };
  std::vector<Near> near;                     ///< light samples within a group's error of an edge
  std::vector<glm::vec3> p;                   ///< of a cluster's view samples
  std::vector<std::uint32_t> planes, leaves;  ///< of a cluster's view samples
  std::uint64_t candidates = 0, counted = 0;  ///< edges tested for view samples; edges that appeared on the light
};

/// Counts the triangles between each view sample and each light sample (in tiles) at silhouette edges. `masks`: one for
/// each view sample; all of its bits are written or none.
void count_samples(const ClusterInput& input, EdgeScratch& scratch, CountScratch& counting, OpenJudge& judge,
                   std::span<SampleMask> masks);

}  // namespace penumbra::volumes
