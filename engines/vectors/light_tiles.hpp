// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Light samples that are not in rows of a rectangle.
namespace penumbra::vectors {

/// A float for each slot of whole tiles, each tile on its own cache line.
class SlotFloats {
 public:
  static constexpr std::size_t kWide = 16;

  void resize(std::size_t tiles) { tiles_.resize(tiles); }
  float& operator[](std::size_t slot) { return tiles_[slot / kWide].of[slot % kWide]; }
  const float& operator[](std::size_t slot) const { return tiles_[slot / kWide].of[slot % kWide]; }

 private:
  struct alignas(64) Tile {
    std::array<float, kWide> of{};
  };
  std::vector<Tile> tiles_;
};

/// Light samples at arbitrary places of a light: sixteen neighbours form a tile, and tiles side by side form a row of
/// tiles. Tiles are about as high as wide, so that a straight edge crosses few of them. A light sample's slot is its
/// position in this order; a tile's sixteen bits are a word of masks.
struct LightTiles {
  static constexpr std::uint32_t kWide = SlotFloats::kWide;  ///< light samples of a tile
  static constexpr std::uint32_t kNone = 0xffffffffU;
  static constexpr float kStepsPerCell = 4;  ///< steps of row_from
  static constexpr std::uint32_t kMostRows = 16;
  static constexpr std::uint32_t kMostSteps = 256;  ///< steps of tiles_at, approximately

  struct Row {
    float low = 0, high = 0;             ///< the smallest and the largest Y of its samples
    std::uint32_t first = 0, count = 0;  ///< indices of its tiles
  };
  std::vector<Row> rows;               ///< ascending: their ranges of Y have at most an end in common
  std::vector<std::int32_t> row_from;  ///< for each step upward from Y = −½: no row below this one reaches that height
  SlotFloats x, y;                     ///< coordinates of each slot, in cells; NaN for slots without a sample
  using RowFloats = std::array<float, kMostRows + 1>;
  RowFloats row_low{}, row_high{};  ///< low and high of each row; unreachable values for missing rows
  /// For each row and each of `steps` steps to the right from X = −½ (the first and the last stand for everything
  /// beyond): the first tile that reaches that X, and, times 2¹⁶, the end of the tiles that begin no farther to the
  /// right.
  std::vector<std::int32_t> tiles_at;
  std::int32_t steps = 1;
  float steps_per_cell = 1;
  /// The smallest and the largest X of each tile; padded by kWide, so that vector loads may read beyond the end.
  std::vector<float> tile_low, tile_high;
  std::vector<std::uint16_t> used;       ///< for each tile, a bit for each slot with a sample
  std::vector<std::uint32_t> sample_of;  ///< for each slot, its light sample or kNone
  std::vector<std::uint32_t> slot_of;    ///< for each light sample, its slot
  float most_sum = 0;                    ///< largest X + Y of all samples
  float most_difference = 0;             ///< largest X − Y of all samples, of tiles' lower left corners and of the
                                         ///< light's corner

  [[nodiscard]] std::size_t tile_count() const { return used.size(); }
};

/// Makes tiles. `places`: positions of light samples, in cells.
LightTiles make_light_tiles(std::span<const glm::vec2> places);

}  // namespace penumbra::vectors
