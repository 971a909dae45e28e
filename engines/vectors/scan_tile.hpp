#pragma once

#include "visibility/view_samples.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::vectors {

/// Pixels a side of a tile: what its pixels hold fits into the first cache.
inline constexpr std::uint32_t kScanTile = 32;
/// With those that the last vector of the last row reads beyond it.
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
  std::vector<double> across, upward;  ///< one a column and one a row; `across` may be read past its end by a vector
};

/// What the pixels of one tile have met so far, in rows of kScanTile; kScanSlots of each.
struct ScanTile {
  std::uint32_t first_x = 0, first_y = 0;
  std::span<double> nearest;        ///< smallest t; infinity where there is none, −infinity beside the picture
  std::span<std::int64_t> carrier;  ///< its triangle; at equal t the first by SceneFloats::comes_before, then by number
};

/// Lets the triangles of a tile, in any order, take the pixels that they cover (visibility::cover, the same operations
/// in the same order). Returns the largest of the tile's smallest t.
double scan_tile(const visibility::SceneFloats& scene, const ScanCamera& camera, std::span<const TileEntry> entries,
                 const ScanTile& tile);

}  // namespace penumbra::vectors
