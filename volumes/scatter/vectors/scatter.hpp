#pragma once

#include "volumes/edges/vectors/edge_scratch.hpp"
#include "volumes/edges/vectors/group.hpp"

#include <cstdint>
#include <span>
#include <vector>

/// Edge scatter on a processor, light samples in rows. Inside volumes/ only.
namespace penumbra::volumes {

/// An edge that vectors leave to scatter_precisely (precise.hpp): k as the table has it.
struct PreciseEdge {
  std::uint32_t edge;  ///< in the EdgeTable
  float k;
  bool settled;
};

/// Buffers of one thread, beside EdgeScratch.
struct RowScratch {
  std::vector<std::int32_t> landing, jump;  // scattered changes: where in the histogram, and by how much
  std::vector<PreciseEdge> precise;
  std::vector<std::int8_t> bytes;  // Changes
  std::vector<std::int16_t> words;
  std::vector<std::int32_t> wide_words;
};

/// `masks`: one for each view sample; of its bits all or none are written.
void scatter(const ClusterInput& input, EdgeScratch& found, RowScratch& scratch, OpenJudge& judge,
             std::span<SampleMask> masks);

}  // namespace penumbra::volumes
