// SPDX-License-Identifier: Apache-2.0
// Cuts masks of light samples at the plane of the carrying triangle: rows by whole columns, tiles by vectors of
// samples.

#include "engines/vectors/horizon.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engines/vectors/horizon.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace penumbra::vectors::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <class Tag>
std::uint32_t bits_of(Tag d, hn::Mask<Tag> which) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, which, bytes);
  return bytes[0] | std::uint32_t{bytes[1]} << 8U;
}

/// Clears the bits of a vector of light samples, from bit `place` on, that are not certainly above the horizon; returns
/// the bits of the uncertain ones.
template <class Tag>
std::uint32_t cut(Tag d, hn::Vec<Tag> value, float error, std::uint32_t place, std::uint16_t& word) {
  const std::uint32_t lanes = (1U << hn::Lanes(d)) - 1;
  const std::uint32_t is_above = bits_of(d, hn::Gt(value, hn::Set(d, error))),
                      may_be = bits_of(d, hn::Ge(value, hn::Set(d, -error)));
  word = static_cast<std::uint16_t>(word & ~((lanes & ~is_above) << place));
  return may_be & ~is_above & lanes;
}

/// Returns how far a bound of A s + B t + C over several light samples must be from 0 to decide the side of all of
/// them: the bound and the sums themselves round three products and three sums, of at most four times these terms.
float sure_of(const GridSample& at) {
  return at.above_error + 64 * kRound * (std::abs(at.above.x) + std::abs(at.above.y) + std::abs(at.above.z));
}

/// Tiles of a row, at most sixteen from `first` on, as bits: those that the horizon may cross, and those completely
/// below it. The horizon does not affect other tiles.
struct TilesAtHorizon {
  std::uint32_t passed = 0, below = 0;
};
TilesAtHorizon find_passed(const LightGrid& grid, const GridSample& at, const LightTiles::Row& row,
                           std::uint32_t first) {
  const hn::CappedTag<float, 16> d;
  const LightTiles& tiles = *grid.tiles;
  const float per_column = at.above.x / grid.half_cells.x, per_row = at.above.y / grid.half_cells.y;
  const float y0 = per_row * (row.low - grid.first_cell.y), y1 = per_row * (row.high - grid.first_cell.y);
  const float sure = sure_of(at);
  const auto least_y = hn::Set(d, at.above.z + std::min(y0, y1)), most_y = hn::Set(d, at.above.z + std::max(y0, y1));
  const auto column = hn::Set(d, per_column), middle = hn::Set(d, grid.first_cell.x);
  TilesAtHorizon found;
  for (std::uint32_t tile = first; tile < std::min(first + 16, row.count);
       tile += static_cast<std::uint32_t>(hn::Lanes(d))) {
    const auto x0 = hn::Mul(hn::Sub(hn::LoadU(d, &tiles.tile_low[row.first + tile]), middle), column);
    const auto x1 = hn::Mul(hn::Sub(hn::LoadU(d, &tiles.tile_high[row.first + tile]), middle), column);
    const auto used = hn::FirstN(d, row.count - tile);
    const auto above = hn::Gt(hn::Add(least_y, hn::Min(x0, x1)), hn::Set(d, sure));
    const auto below = hn::Lt(hn::Add(most_y, hn::Max(x0, x1)), hn::Set(d, -sure));
    found.passed |= bits_of(d, hn::AndNot(hn::Or(above, below), used)) << (tile - first);
    found.below |= bits_of(d, hn::And(below, used)) << (tile - first);
  }
  return found;
}

void cut_tile(const LightGrid& grid, const GridSample& at, std::size_t tile, Open& open, SampleMask& mask) {
  const hn::CappedTag<float, LightTiles::kWide> d;
  const LightTiles& tiles = *grid.tiles;
  const auto constant = [&](float x) { return hn::Set(d, x); };
  const float per_column = at.above.x / grid.half_cells.x, per_row = at.above.y / grid.half_cells.y;
  for (std::uint32_t lane = 0; lane < LightTiles::kWide; lane += static_cast<std::uint32_t>(hn::Lanes(d))) {
    const std::size_t slot = tile * LightTiles::kWide + lane;
    const auto x = hn::Sub(hn::LoadU(d, &tiles.x[slot]), constant(grid.first_cell.x));
    const auto y = hn::Sub(hn::LoadU(d, &tiles.y[slot]), constant(grid.first_cell.y));
    const auto value = hn::MulAdd(y, constant(per_row), hn::MulAdd(x, constant(per_column), constant(at.above.z)));
    for (std::uint32_t left = cut(d, value, at.above_error, lane, mask.bits[tile]); left != 0; left &= left - 1)
      open.samples.push_back(tiles.sample_of[slot + static_cast<std::size_t>(std::countr_zero(left))]);
  }
}

void cut_tiles(const LightGrid& grid, const GridSample& at, Open& open, SampleMask& mask) {
  const LightTiles& tiles = *grid.tiles;
  for (const LightTiles::Row& row : tiles.rows) {
    for (std::uint32_t first = 0; first < row.count; first += 16) {
      const TilesAtHorizon found = find_passed(grid, at, row, first);
      for (std::uint32_t left = found.passed; left != 0; left &= left - 1)
        cut_tile(grid, at, row.first + first + static_cast<std::size_t>(std::countr_zero(left)), open, mask);
      for (std::uint32_t left = found.below; left != 0; left &= left - 1)
        mask.bits[row.first + first + static_cast<std::uint32_t>(std::countr_zero(left))] = 0;
    }
  }
  mask.count(tiles.tile_count());
}

void cut_at_horizon_here(const LightGrid& grid, const GridSample& at, Open& open, SampleMask& mask) {
  if (grid.tiles) return cut_tiles(grid, at, open, mask);
  const hn::CappedTag<float, 16> d;
  const std::size_t words = grid.padded_rows / 16;
  const auto constant = [&](float x) { return hn::Set(d, x); };
  const float per_column = at.above.x / grid.half_cells.x, per_row = at.above.y / grid.half_cells.y;
  const float sure = sure_of(at);
  for (std::uint32_t first = 0; first < grid.padded_rows; first += static_cast<std::uint32_t>(hn::Lanes(d))) {
    const auto rows =
        hn::Sub(hn::Add(hn::Iota(d, 0.0F), hn::Set(d, static_cast<float>(first))), constant(grid.first_cell.y));
    const auto shifts = hn::Sub(hn::LoadU(d, &grid.shift[first]), constant(grid.first_cell.x));
    const auto value_of_row =
        hn::MulAdd(rows, constant(per_row), hn::MulAdd(shifts, constant(per_column), constant(at.above.z)));
    const float least = hn::GetLane(hn::MinOfLanes(d, value_of_row)),
                most = hn::GetLane(hn::MaxOfLanes(d, value_of_row));
    const std::uint32_t lanes = (1U << hn::Lanes(d)) - 1, place = first % 16;
    // Begins with the column that is farthest below the horizon, so all columns after the first one above the horizon
    // are above it, too.
    for (std::uint32_t i = 0; i < grid.columns; ++i) {
      const std::uint32_t column = per_column < 0 ? grid.columns - 1 - i : i;
      const float of_column = static_cast<float>(column) * per_column;
      if (of_column + least > sure) break;
      std::uint16_t& word = mask.bits[column * words + first / 16];
      const auto seen = [&] { return static_cast<std::uint32_t>(std::popcount(word & lanes << place)); };
      mask.visible -= seen();
      if (of_column + most < -sure) {
        word = static_cast<std::uint16_t>(word & ~(lanes << place));
        continue;
      }
      const auto value = hn::MulAdd(constant(static_cast<float>(column)), constant(per_column), value_of_row);
      for (std::uint32_t left = cut(d, value, at.above_error, place, word); left != 0; left &= left - 1) {
        const std::uint32_t row = first + static_cast<std::uint32_t>(std::countr_zero(left));
        if (row < grid.rows) open.samples.push_back(row * grid.columns + column);
      }
      mask.visible += seen();
    }
  }
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
