// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/view_samples.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::vectors {

/// Pixels on a side of a tile: its data fits into the first-level cache.
inline constexpr std::uint32_t kScanTile = 32;
/// Slots of a tile, including those that the last vector of the last row reads beyond the end.
inline constexpr std::size_t kScanSlots = std::size_t{kScanTile} * kScanTile + 8;

/// A triangle and the pixels of a tile that it may cover, both ends included.
struct TileEntry {
  std::uint32_t triangle;
  std::uint8_t left, right, top, bottom;
};

/// A camera with the factors of its rays (PinholeCamera::direction) for whole columns and rows.
struct ScanCamera {
  explicit ScanCamera(const visibility::PinholeCamera& camera);

  visibility::PinholeCamera view;
  std::vector<double> across, upward;  ///< one for each column and one for each row; `across` is padded for a vector
                                       ///< read past its end
};

/// The nearest hits of one tile's pixels, in rows of kScanTile; kScanSlots of each.
struct ScanTile {
  std::uint32_t first_x = 0, first_y = 0;
  std::span<double> nearest;        ///< smallest t; infinity without a hit, −infinity outside of the picture
  std::span<std::int64_t> carrier;  ///< its triangle; at equal t the first by SceneFloats::comes_before, then by index
};

/// Draws the triangles of a tile, in any order, into the pixels that they cover (visibility::cover, the same operations
/// in the same order). Returns the largest of the tile's smallest t.
double scan_tile(const visibility::SceneFloats& scene, const ScanCamera& camera, std::span<const TileEntry> entries,
                 const ScanTile& tile);

}  // namespace penumbra::vectors
