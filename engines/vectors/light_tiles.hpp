#pragma once

#include <glm/vec2.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Light samples that form no rows of a rectangle.
namespace penumbra::vectors {

/// Light samples anywhere on a light: sixteen neighbours are a tile, tiles that lie side by side a row of tiles. So a
/// straight edge has few tiles on both of its sides, and of all others of a row that it crosses one number says how
/// they change. A light sample's slot is its place in this order; a tile's sixteen bits are a word of masks.
struct LightTiles {
  static constexpr std::uint32_t kWide = 16;  ///< light samples of a tile
  static constexpr std::uint32_t kNone = 0xffffffffU;
  static constexpr float kStepsPerCell = 4;  ///< of row_from

  struct Row {
    float low = 0, high = 0;             ///< the least and the largest Y of its samples
    std::uint32_t first = 0, count = 0;  ///< tiles
  };
  std::vector<Row> rows;               ///< from low to high: their heights have no more than an end in common
  std::vector<std::int32_t> row_from;  ///< of each step upward from Y = −½: no row below this one reaches so high
  std::vector<float> x, y;             ///< of each slot, in cells; NaN where there is no sample
  std::vector<float> tile_low, tile_high;  ///< the least and the largest X of each tile
  std::vector<std::uint16_t> used;         ///< of each tile: a bit a slot with a sample
  std::vector<float> start;  ///< of each slot: 0, and where there is no sample what no depth adds up to 0 with
  std::vector<std::uint32_t> sample_of;  ///< of each slot; kNone
  std::vector<std::uint32_t> slot_of;    ///< of each light sample
  float most_sum = 0;                    ///< of X + Y of all samples
  float most_difference = 0;             ///< of X − Y, and of the light's corner

  [[nodiscard]] std::size_t tile_count() const { return used.size(); }
};

/// `places`: of light samples, in cells.
LightTiles make_light_tiles(std::span<const glm::vec2> places);

}  // namespace penumbra::vectors
