// Light samples in tiles.

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
    for (const std::uint32_t different : {1U, 3U, 1U << 20U}) {  // many in one place, or few
      std::vector<glm::vec2> places(count);
      for (glm::vec2& at : places) at = {random() % different, random() % different};
      const LightTiles tiles = make_light_tiles(places);
      ASSERT_EQ(tiles.tile_count(), (count + 15) / 16);
      std::vector<int> met(count, 0);
      std::uint32_t next = 0;
      const auto rows = static_cast<std::uint32_t>(tiles.rows.size());
      ASSERT_LE(rows, count <= 256 ? 16 : tiles.rows.front().count + 2);
      ASSERT_LE(tiles.rows.front().count, count <= 256 ? 1 : rows + 2);
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

}  // namespace
}  // namespace penumbra::vectors
