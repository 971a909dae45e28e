// SPDX-License-Identifier: Apache-2.0
// Tests the device's layout of arbitrary light samples: in rows, four slots at a time.

#include "volumes/scatter/point_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace penumbra::volumes {
namespace {

/// Returns coordinates in [−1, 1]² with `different` different numbers.
std::vector<glm::vec2> coordinates_of(std::mt19937& random, std::uint32_t count, std::uint32_t different) {
  std::vector<glm::vec2> coordinates(count);
  const auto one = [&] {
    return different == 1 ? 0.25F
                          : 2.0F * static_cast<float>(random() % different) / static_cast<float>(different - 1) - 1.0F;
  };
  for (glm::vec2& at : coordinates) at = {one(), one()};
  return coordinates;
}

/// Tests the slot at which the shader starts to look for light samples at x or further right, for places slightly right
/// of a start.
void expect_starts(const PointRows& rows, std::uint32_t row, const std::vector<float>& x) {
  for (std::uint32_t start = 0; start < rows.columns * gpu::kStartsPerCell; ++start) {
    const std::uint32_t four = rows.starts[row * rows.columns * gpu::kStartsPerCell + start];
    ASSERT_LT(four, rows.fours);
    const float from = static_cast<float>(start) / gpu::kStartsPerCell - 0.5F;
    for (std::size_t slot = 0; slot < std::min(x.size(), std::size_t{four} * gpu::kPointsAtOnce); ++slot)
      ASSERT_LT(x[slot], from) << "row " << row << " start " << start;
  }
}

TEST(PointRows, HoldEachSampleOnceInItsRow) {
  std::mt19937 random(5);
  for (const std::uint32_t count : {1U, 2U, 3U, 15U, 16U, 17U, 70U, 256U, 1000U, 4096U}) {
    for (const std::uint32_t different : {1U, 3U, 64U, 1U << 20U}) {  // many samples share a place, or few do
      const std::vector<glm::vec2> coordinates = coordinates_of(random, count, different);
      const std::uint32_t most = count % 2 == 0 ? 3 : 1024;
      const PointRows rows = make_point_rows(coordinates, most);
      ASSERT_TRUE(rows.fours <= most || different <= 64);
      const std::uint32_t slots = rows.fours * gpu::kPointsAtOnce;
      ASSERT_EQ(rows.sample_of.size(), std::size_t{rows.rows} * slots);
      ASSERT_EQ(rows.places.size(), std::size_t{rows.rows} * rows.fours * 2);
      const glm::dvec2 half(0.5 * rows.columns, 0.5 * rows.rows);
      std::vector<int> met(count, 0);
      for (std::uint32_t row = 0; row < rows.rows; ++row) {
        std::vector<float> x_of_row;
        for (std::uint32_t slot = 0; slot < slots; ++slot) {
          const std::size_t four = std::size_t{row} * rows.fours + slot / 4;
          const float x = rows.places[2 * four][static_cast<glm::length_t>(slot % 4)],
                      y = rows.places[2 * four + 1][static_cast<glm::length_t>(slot % 4)];
          const std::uint32_t sample = rows.sample_of[std::size_t{row} * slots + slot];
          if (sample == PointRows::kNone) {
            ASSERT_EQ(x, 1e30F);
            continue;
          }
          ASSERT_EQ(x_of_row.size(), slot) << "a gap in a row";
          ASSERT_TRUE(x_of_row.empty() || x >= x_of_row.back());
          x_of_row.push_back(x);
          ++met[sample];
          ASSERT_LE(std::abs(static_cast<double>(y) - row), 0.5);
          ASSERT_EQ(glm::vec2(x, y), glm::vec2(half - 0.5 + half * glm::dvec2(coordinates[sample])));
        }
        expect_starts(rows, row, x_of_row);
      }
      ASSERT_EQ(std::ranges::count(met, 1), count);
    }
  }
}

}  // namespace
}  // namespace penumbra::volumes
