// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/edges/vectors/edge_scratch.hpp"
#include "volumes/edges/vectors/group.hpp"

#include <cstdint>
#include <span>
#include <vector>

/// Edge scatter on a processor, light samples in tiles. Inside volumes/ only.
namespace penumbra::volumes {

/// Buffers of one thread, in addition to EdgeScratch.
struct PointScratch {
  std::vector<std::int32_t> tile_changes, row_changes, tile_depths;  // see PointChanges
  vectors::SlotFloats depths;                                        // 0 between view samples
  std::vector<std::uint8_t> is_touched;                              // for each tile; 0 between view samples
  std::vector<std::uint32_t> touched;
};

/// Computes masks, like scatter() in scatter.hpp, but for light samples that are not in rows.
void scatter_points(const ClusterInput& input, EdgeScratch& found, PointScratch& scratch, OpenJudge& judge,
                    std::span<SampleMask> masks);

}  // namespace penumbra::volumes
