// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/raster/light_volumes.hpp"
#include "volumes/raster/volume_count.shared.h"

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::volumes {

/// Side of a tile, in pixels: T. Aila, T. Akenine-Möller, A hierarchical shadow volume algorithm, Graphics Hardware
/// 2004.
inline constexpr std::uint32_t kTileSide = 8;
inline constexpr std::uint32_t kNoPixel = 0xffffffffU;

/// The view samples that must be counted so that all counts are known.
struct TilePlan {
  std::vector<std::uint32_t> stand_ins;  ///< for each pixel, a counted pixel with the same count: itself or, in a whole
                                         ///< tile, the tile's first counted pixel; kNoPixel where nothing is counted
  std::uint64_t tiles = 0, whole = 0;    ///< number of tiles with counted pixels, and how many of them no face touches
};

/// Finds the whole tiles among rows of `width` pixels: those inside or outside each shadow volume. Conservative: a tile
/// is whole only if no face of `volumes`, as counted for its view samples, meets their box.
[[nodiscard]] TilePlan plan_tiles(const LightVolumes& volumes, std::span<const gpu::VolumeReceiver> receivers,
                                  std::uint32_t width);

}  // namespace penumbra::volumes
