#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Light samples that form no rows of a rectangle.
namespace penumbra::vectors {

/// A float of each slot, of whole tiles: each tile's on a cache line of its own.
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

/// Light samples anywhere on a light: sixteen neighbours are a tile, tiles that lie side by side a row of tiles. Tiles
/// are about as high as they are wide, so that a straight edge has few of them on both of its sides. A light sample's
/// slot is its place in this order; a tile's sixteen bits are a word of masks.
struct LightTiles {
  static constexpr std::uint32_t kWide = SlotFloats::kWide;  ///< light samples of a tile
  static constexpr std::uint32_t kNone = 0xffffffffU;
  static constexpr float kStepsPerCell = 4;  ///< of row_from
  static constexpr std::uint32_t kMostRows = 16;
  static constexpr std::uint32_t kMostSteps = 256;  ///< of tiles_at, or a few more

  struct Row {
    float low = 0, high = 0;             ///< the least and the largest Y of its samples
    std::uint32_t first = 0, count = 0;  ///< tiles
  };
  std::vector<Row> rows;               ///< from low to high: their heights have no more than an end in common
  std::vector<std::int32_t> row_from;  ///< of each step upward from Y = −½: no row below this one reaches so high
  SlotFloats x, y;                     ///< of each slot, in cells; NaN where there is no sample
  using RowFloats = std::array<float, kMostRows + 1>;
  RowFloats row_low{}, row_high{};  ///< of each row, the same; of those that are not there, out of reach
  /// Of each row, of each of `steps` to the right from X = −½ (the first and the last stand for all beyond): the first
  /// tile that reaches so far to the right, and, 2¹⁶ times, the end of those that begin no farther to the right.
  std::vector<std::int32_t> tiles_at;
  std::int32_t steps = 1;
  float steps_per_cell = 1;
  /// The least and the largest X of each tile; kWide more, so that vectors may read on.
  std::vector<float> tile_low, tile_high;
  std::vector<std::uint16_t> used;       ///< of each tile: a bit a slot with a sample
  std::vector<std::uint32_t> sample_of;  ///< of each slot; kNone
  std::vector<std::uint32_t> slot_of;    ///< of each light sample
  float most_sum = 0;                    ///< of X + Y of all samples
  float most_difference = 0;             ///< of X − Y, also of tiles' lower left corners and of the light's corner

  [[nodiscard]] std::size_t tile_count() const { return used.size(); }
};

/// `places`: of light samples, in cells.
LightTiles make_light_tiles(std::span<const glm::vec2> places);

}  // namespace penumbra::vectors
