// SPDX-License-Identifier: Apache-2.0
// Tests the sorting of light samples into tiles.

#include "engines/vectors/light_tiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace penumbra::vectors {
namespace {

TEST(LightTiles, HoldEachSampleOnce) {
  std::mt19937 random(3);
  for (const std::uint32_t count : {1U, 2U, 16U, 17U, 33U, 256U, 1000U, 4096U, 65536U}) {
    for (const std::uint32_t different : {1U, 3U, 1U << 20U}) {  // many samples share a place, or few do
      std::vector<glm::vec2> places(count);
      for (glm::vec2& at : places) at = {random() % different, random() % different};
      const LightTiles tiles = make_light_tiles(places);
      ASSERT_EQ(tiles.tile_count(), (count + 15) / 16);
      std::vector<int> met(count, 0);
      std::uint32_t next = 0;
      const auto rows = static_cast<std::uint32_t>(tiles.rows.size());
      ASSERT_EQ(rows, std::min(std::lround(std::sqrt(tiles.tile_count())), long{LightTiles::kMostRows}));
      ASSERT_LE(tiles.rows.front().count, (tiles.tile_count() + rows - 1) / rows);
      ASSERT_GE(tiles.tile_low.size(), tiles.tile_count() + LightTiles::kWide);
      ASSERT_GE(tiles.tile_high.size(), tiles.tile_count() + LightTiles::kWide);
      for (std::size_t i = 0; i < tiles.rows.size(); ++i) {
        const LightTiles::Row& row = tiles.rows[i];
        ASSERT_EQ(row.first, next);
        ASSERT_GT(row.count, 0U);
        next += row.count;
        ASSERT_TRUE(i == 0 || row.low >= tiles.rows[i - 1].high);
        for (std::uint32_t tile = row.first; tile < next; ++tile) {
          ASSERT_LE(tiles.tile_low[tile] - row.low, tiles.most_difference);
          ASSERT_TRUE(tile == row.first || tiles.tile_low[tile] >= tiles.tile_high[tile - 1]);
          for (std::uint32_t lane = 0; lane < LightTiles::kWide; ++lane) {
            const std::uint32_t slot = tile * LightTiles::kWide + lane, sample = tiles.sample_of[slot];
            ASSERT_EQ(sample != LightTiles::kNone, (tiles.used[tile] >> lane & 1) != 0);
            if (sample == LightTiles::kNone) {
              ASSERT_TRUE(std::isnan(tiles.x[slot]) && std::isnan(tiles.y[slot]));
              continue;
            }
            ++met[sample];
            ASSERT_EQ(tiles.slot_of[sample], slot);
            ASSERT_EQ(glm::vec2(tiles.x[slot], tiles.y[slot]), places[sample]);
            ASSERT_LE(tiles.x[slot] + tiles.y[slot], tiles.most_sum);
            ASSERT_LE(tiles.x[slot] - tiles.y[slot], tiles.most_difference);
            ASSERT_TRUE(row.low <= tiles.y[slot] && tiles.y[slot] <= row.high);
            ASSERT_TRUE(tiles.tile_low[tile] <= tiles.x[slot] && tiles.x[slot] <= tiles.tile_high[tile]);
          }
        }
      }
      ASSERT_EQ(next, tiles.tile_count());
      ASSERT_EQ(std::ranges::count(met, 1), count);
      for (std::size_t step = 0; step < tiles.row_from.size(); ++step) {
        for (std::int32_t row = 0; row < tiles.row_from[step]; ++row)
          ASSERT_LT(tiles.rows[static_cast<std::size_t>(row)].high,
                    static_cast<float>(step) / LightTiles::kStepsPerCell - 0.5F);
      }
    }
  }
}

/// Uses light samples at random places in 64 × 64 cells; the case with 40 samples has all of them at one place.
TEST(LightTiles, TableOfStepsGivesEveryTileThatMayContainX) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> across(-0.5F, 63.5F), anywhere(-100.0F, 200.0F);
  for (const std::uint32_t count : {1U, 16U, 40U, 256U, 1000U, 4096U}) {
    std::vector<glm::vec2> places(count);
    for (glm::vec2& at : places) at = count == 40 ? glm::vec2(3, 7) : glm::vec2(across(random), across(random));
    const LightTiles tiles = make_light_tiles(places);
    ASSERT_LE(tiles.steps, static_cast<std::int32_t>(LightTiles::kMostSteps) + 2);
    for (std::size_t i = 0; i < tiles.rows.size(); ++i) {
      const LightTiles::Row& row = tiles.rows[i];
      ASSERT_EQ(tiles.row_low[i], row.low);
      ASSERT_EQ(tiles.row_high[i], row.high);
      for (int once = 0; once < 2000; ++once) {
        const auto some = static_cast<std::uint32_t>(row.first + random() % row.count);
        const float x = once % 3 == 0 ? anywhere(random) : once % 3 == 1 ? tiles.tile_low[some] : tiles.tile_high[some];
        const float step = std::clamp((x + 0.5F) * tiles.steps_per_cell, 0.0F, static_cast<float>(tiles.steps - 1));
        const std::int32_t found =
            tiles.tiles_at[i * static_cast<std::size_t>(tiles.steps) + static_cast<std::size_t>(step)];
        const auto first = static_cast<std::uint32_t>(found & 0xffff), end = static_cast<std::uint32_t>(found >> 16);
        ASSERT_LE(row.first, first);
        ASSERT_LE(end, row.first + row.count);
        for (std::uint32_t tile = row.first; tile < row.first + row.count; ++tile) {
          if (tiles.tile_high[tile] >= x) {
            ASSERT_LE(first, tile) << x;
          }
          if (tiles.tile_low[tile] <= x) {
            ASSERT_GT(end, tile) << x;
          }
        }
        // The first tile of the table is at most one step too early.
        if (first > row.first && x < 63) {
          ASSERT_LT(tiles.tile_high[first - 1], x + 0.01F);
        }
      }
    }
    ASSERT_GT(tiles.row_low[tiles.rows.size()], 1e30F);
  }
}

}  // namespace
}  // namespace penumbra::vectors
