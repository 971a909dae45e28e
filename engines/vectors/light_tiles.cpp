// SPDX-License-Identifier: Apache-2.0
// Sorts light samples that are not in rows into tiles of sixteen, with look-up tables by row and column.

#include "engines/vectors/light_tiles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace penumbra::vectors {
namespace {

std::uint32_t divided_up(std::uint32_t x, std::uint32_t by) {
  return (x + by - 1) / by;
}

/// Returns a number of rows close to the number of tiles in each, so that edges pass few tiles.
std::uint32_t rows_for(std::uint32_t tiles) {
  return std::min(static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(tiles)))),
                  LightTiles::kMostRows);
}

void add_row(LightTiles& tiles, std::span<const glm::vec2> places, std::span<std::uint32_t> samples) {
  LightTiles::Row row{places[samples.front()].y, places[samples.back()].y,
                      static_cast<std::uint32_t>(tiles.tile_count()),
                      divided_up(static_cast<std::uint32_t>(samples.size()), LightTiles::kWide)};
  tiles.rows.push_back(row);
  std::ranges::sort(samples, {}, [&](std::uint32_t j) { return std::pair(places[j].x, j); });
  for (std::uint32_t tile = 0; tile < row.count; ++tile) {
    const std::size_t begin = std::size_t{tile} * LightTiles::kWide;
    const auto its = samples.subspan(begin, std::min<std::size_t>(LightTiles::kWide, samples.size() - begin));
    tiles.tile_low.push_back(places[its.front()].x);
    tiles.tile_high.push_back(places[its.back()].x);
    tiles.used.push_back(static_cast<std::uint16_t>((1U << its.size()) - 1));
    for (std::size_t lane = 0; lane < LightTiles::kWide; ++lane) {
      const bool is_sample = lane < its.size();
      const std::size_t slot = tiles.sample_of.size();
      if (is_sample) tiles.slot_of[its[lane]] = static_cast<std::uint32_t>(slot);
      tiles.sample_of.push_back(is_sample ? its[lane] : LightTiles::kNone);
      tiles.x[slot] = is_sample ? places[its[lane]].x : std::numeric_limits<float>::quiet_NaN();
      tiles.y[slot] = is_sample ? places[its[lane]].y : std::numeric_limits<float>::quiet_NaN();
    }
  }
}

/// `right`: the largest X of all samples.
void add_steps(LightTiles& tiles, float right) {
  constexpr float kPerCell = 4;
  // A looked-up value has been rounded twice, and so have the steps' limits here, by 2⁻²⁴ of the distance from −½ each.
  const float margin = 0x1p-21F * (right + 1);
  tiles.steps_per_cell = std::min(kPerCell, static_cast<float>(LightTiles::kMostSteps) / (right + 1));
  tiles.steps = static_cast<std::int32_t>((right + 0.5F) * tiles.steps_per_cell) + 2;
  tiles.tiles_at.reserve(tiles.rows.size() * static_cast<std::size_t>(tiles.steps));
  for (const LightTiles::Row& row : tiles.rows) {
    const auto low = tiles.tile_low.begin() + row.first, high = tiles.tile_high.begin() + row.first;
    for (std::int32_t step = 0; step < tiles.steps; ++step) {
      const float at = static_cast<float>(step) / tiles.steps_per_cell - 0.5F, next = at + 1 / tiles.steps_per_cell;
      const bool is_first = step == 0, is_last = step + 1 == tiles.steps;  // first and last step also stand for
                                                                           // everything beyond
      const auto first = is_first ? high : std::lower_bound(high, high + row.count, at - margin);
      const auto end = is_last ? low + row.count : std::upper_bound(low, low + row.count, next + margin);
      tiles.tiles_at.push_back(static_cast<std::int32_t>(row.first + (first - high)) |
                               static_cast<std::int32_t>(row.first + (end - low)) << 16);
    }
  }
}

}  // namespace

LightTiles make_light_tiles(std::span<const glm::vec2> places) {
  LightTiles tiles;
  tiles.slot_of.resize(places.size());
  std::vector<std::uint32_t> by_y(places.size());
  std::iota(by_y.begin(), by_y.end(), 0U);
  std::ranges::sort(by_y, {}, [&](std::uint32_t j) { return std::pair(places[j].y, j); });
  const std::uint32_t count = divided_up(static_cast<std::uint32_t>(places.size()), LightTiles::kWide),
                      rows = rows_for(count);
  tiles.x.resize(count);
  tiles.y.resize(count);
  for (std::uint32_t row = 0; row < rows; ++row) {
    const std::size_t begin = std::size_t{count} * row / rows * LightTiles::kWide,
                      end = std::min(std::size_t{count} * (row + 1) / rows * LightTiles::kWide, places.size());
    add_row(tiles, places, std::span(by_y).subspan(begin, end - begin));
  }
  tiles.most_sum = -std::numeric_limits<float>::infinity();
  tiles.most_difference = 0;                     // the light's corner is left of all tiles
  for (const LightTiles::Row& one : tiles.rows)  // a row's last tile begins farthest to the right
    tiles.most_difference = std::max(tiles.most_difference, tiles.tile_low[one.first + one.count - 1] - one.low);
  add_steps(tiles, std::max(0.0F, *std::ranges::max_element(tiles.tile_high)));
  tiles.row_low.fill(std::numeric_limits<float>::max());
  tiles.row_high = tiles.row_low;
  std::ranges::transform(tiles.rows, tiles.row_low.begin(), &LightTiles::Row::low);
  std::ranges::transform(tiles.rows, tiles.row_high.begin(), &LightTiles::Row::high);
  tiles.tile_low.resize(count + LightTiles::kWide);
  tiles.tile_high.resize(count + LightTiles::kWide);
  for (const glm::vec2& place : places) {
    tiles.most_sum = std::max(tiles.most_sum, place.x + place.y);
    tiles.most_difference = std::max(tiles.most_difference, place.x - place.y);
  }
  std::int32_t row = 0;
  for (float step = 0; step <= LightTiles::kStepsPerCell * (tiles.rows.back().high + 0.5F) + 1; ++step) {
    // The table begins a row one step early, since values that are looked up are rounded.
    const float height = (step - 1) / LightTiles::kStepsPerCell - 0.5F;
    while (static_cast<std::size_t>(row) + 1 < tiles.rows.size() &&
           tiles.rows[static_cast<std::size_t>(row)].high < height)
      ++row;
    tiles.row_from.push_back(row);
  }
  return tiles;
}

}  // namespace penumbra::vectors
