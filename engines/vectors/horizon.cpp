#include "engines/vectors/horizon.hpp"

#include <algorithm>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engines/vectors/horizon.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace penumbra::vectors::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Clears the `lanes` bits from `place` on of light samples that are not above, and returns those that may be.
template <class Tag>
std::uint32_t cut(Tag d, hn::Vec<Tag> value, float error, std::uint32_t place, std::uint16_t& word) {
  std::uint8_t above[8] = {}, not_below[8] = {};
  hn::StoreMaskBits(d, hn::Gt(value, hn::Set(d, error)), above);
  hn::StoreMaskBits(d, hn::Ge(value, hn::Set(d, -error)), not_below);
  const std::uint32_t lanes = (1U << hn::Lanes(d)) - 1;
  const std::uint32_t is_above = above[0] | std::uint32_t{above[1]} << 8U,
                      may_be = not_below[0] | std::uint32_t{not_below[1]} << 8U;
  word = static_cast<std::uint16_t>(word & ~((lanes & ~is_above) << place));
  return may_be & ~is_above & lanes;
}

void cut_tiles(const LightGrid& grid, const GridSample& at, Open& open, SampleMask& mask) {
  const hn::CappedTag<float, LightTiles::kWide> d;
  const LightTiles& tiles = *grid.tiles;
  const auto constant = [&](float x) { return hn::Set(d, x); };
  const float per_column = at.above.x / grid.half_cells.x, per_row = at.above.y / grid.half_cells.y;
  std::uint32_t visible = 0;
  for (std::size_t tile = 0; tile < tiles.tile_count(); ++tile) {
    for (std::uint32_t lane = 0; lane < LightTiles::kWide; lane += static_cast<std::uint32_t>(hn::Lanes(d))) {
      const std::size_t slot = tile * LightTiles::kWide + lane;
      const auto x = hn::Sub(hn::LoadU(d, &tiles.x[slot]), constant(grid.first_cell.x));
      const auto y = hn::Sub(hn::LoadU(d, &tiles.y[slot]), constant(grid.first_cell.y));
      const auto value = hn::MulAdd(y, constant(per_row), hn::MulAdd(x, constant(per_column), constant(at.above.z)));
      for (std::uint32_t left = cut(d, value, at.above_error, lane, mask.bits[tile]); left != 0; left &= left - 1)
        open.samples.push_back(tiles.sample_of[slot + static_cast<std::size_t>(std::countr_zero(left))]);
    }
    visible += static_cast<std::uint32_t>(std::popcount(mask.bits[tile]));
  }
  mask.visible = visible;
}

void cut_at_horizon_here(const LightGrid& grid, const GridSample& at, Open& open, SampleMask& mask) {
  if (grid.tiles) return cut_tiles(grid, at, open, mask);
  const hn::CappedTag<float, 16> d;
  const std::size_t words = grid.padded_rows / 16;
  const auto constant = [&](float x) { return hn::Set(d, x); };
  std::uint32_t visible = 0;
  const float per_column = at.above.x / grid.half_cells.x, per_row = at.above.y / grid.half_cells.y;
  for (std::uint32_t first = 0; first < grid.padded_rows; first += static_cast<std::uint32_t>(hn::Lanes(d))) {
    const auto rows =
        hn::Sub(hn::Add(hn::Iota(d, 0.0F), hn::Set(d, static_cast<float>(first))), constant(grid.first_cell.y));
    const auto shifts = hn::Sub(hn::LoadU(d, &grid.shift[first]), constant(grid.first_cell.x));
    const auto value_of_row =
        hn::MulAdd(rows, constant(per_row), hn::MulAdd(shifts, constant(per_column), constant(at.above.z)));
    for (std::uint32_t column = 0; column < grid.columns; ++column) {
      const auto value = hn::MulAdd(constant(static_cast<float>(column)), constant(per_column), value_of_row);
      std::uint16_t& word = mask.bits[column * words + first / 16];
      const std::uint32_t lanes = (1U << hn::Lanes(d)) - 1, place = first % 16;
      std::uint32_t left = cut(d, value, at.above_error, place, word);
      visible += static_cast<std::uint32_t>(std::popcount(word & lanes << place));
      for (; left != 0; left &= left - 1) {
        const std::uint32_t row = first + static_cast<std::uint32_t>(std::countr_zero(left));
        if (row < grid.rows) open.samples.push_back(row * grid.columns + column);
      }
    }
  }
  mask.visible = visible;
}

}  // namespace
}  // namespace penumbra::vectors::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::vectors {

HWY_EXPORT(cut_at_horizon_here);

void cut_at_horizon(const LightGrid& grid, const GridSample& at, Open& open, SampleMask& mask) {
  HWY_DYNAMIC_DISPATCH(cut_at_horizon_here)(grid, at, open, mask);
}

void fill(const LightGrid& grid, bool visible, SampleMask& mask) {
  mask.visible = visible ? grid.sample_count : 0;
  if (grid.tiles) {
    for (std::size_t i = 0; i < mask_words(grid); ++i) mask.bits[i] = visible ? grid.tiles->used[i] : std::uint16_t{0};
    return;
  }
  const std::size_t words = grid.padded_rows / 16;
  for (std::size_t i = 0; i < grid.columns * words; ++i) {
    const std::size_t first = i % words * 16,
                      rows = std::min<std::size_t>(grid.rows - std::min<std::size_t>(first, grid.rows), 16);
    mask.bits[i] = visible ? static_cast<std::uint16_t>((1U << rows) - 1) : std::uint16_t{0};
  }
}

void see_all(const LightGrid& grid, const GridSample& at, Open& open, OpenJudge& judge, SampleMask& mask) {
  mask.visible = grid.sample_count;
  if (!at.straddles && !open.any()) return;
  fill(grid, true, mask);
  if (at.straddles) cut_at_horizon(grid, at, open, mask);
  if (open.any()) judge.decide(at, open, mask);
}

}  // namespace penumbra::vectors
#endif
