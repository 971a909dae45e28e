// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/edges/vectors/edge_scratch.hpp"
#include "volumes/edges/vectors/group.hpp"

#include <cstdint>
#include <span>
#include <vector>

/// Edge scatter on a processor, light samples in rows. Inside volumes/ only.
namespace penumbra::volumes {

/// An edge that vectors leave to scatter_precisely (precise.hpp), with the table's k.
struct PreciseEdge {
  std::uint32_t edge;  ///< row in the EdgeTable
  float k;
  bool settled;
};

/// Buffers of one thread, in addition to EdgeScratch.
struct RowScratch {
  std::vector<std::int32_t> landing, jump;  // scattered changes: index in the histogram, and amount
  std::vector<PreciseEdge> precise;
  std::vector<std::int8_t> bytes;  // as in Changes
  std::vector<std::int16_t> words;
  std::vector<std::int32_t> wide_words;
};

/// Computes masks. `masks`: one for each view sample; all of its bits are written or none.
void scatter(const ClusterInput& input, EdgeScratch& found, RowScratch& scratch, OpenJudge& judge,
             std::span<SampleMask> masks);

}  // namespace penumbra::volumes
