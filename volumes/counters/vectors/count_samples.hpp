#pragma once

#include "volumes/edges/vectors/edge_scratch.hpp"
#include "volumes/edges/vectors/group.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// depth-complexity on a processor. Inside volumes/ only.
namespace penumbra::volumes {

/// Buffers of one thread, beside EdgeScratch.
struct CountScratch {
  static constexpr std::size_t kFields = 10;
  Table<kFields> edges;         ///< of those in EdgeScratch::crossing; columns are count_samples.cpp's
  std::vector<float> counters;  ///< of each slot (LightTiles)
  struct Near {
    std::uint32_t edge, slot;
  };
  std::vector<Near> near;                     ///< light samples as near to an edge as a group's error
  std::vector<glm::vec3> p;                   ///< of a cluster
  std::vector<std::uint32_t> planes, leaves;  ///< of a cluster
  std::uint64_t candidates = 0, counted = 0;  ///< edges that view samples were given; that appeared on the light
};

/// Counts the triangles between each view sample and each light sample (in tiles) at silhouette edges. `masks`: one for
/// each view sample; of its bits all or none are written.
void count_samples(const ClusterInput& input, EdgeScratch& scratch, CountScratch& counting, OpenJudge& judge,
                   std::span<SampleMask> masks);

}  // namespace penumbra::volumes
