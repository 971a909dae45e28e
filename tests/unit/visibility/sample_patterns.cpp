// SPDX-License-Identifier: Apache-2.0
#include "visibility/sample_patterns.hpp"

#include "base/error.hpp"

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <span>
#include <utility>

namespace penumbra::visibility {
namespace {

std::vector<glm::dvec2> samples(std::uint32_t count, SamplePattern pattern, std::uint32_t seed = 0) {
  return unit_square_samples({count, 0, 0, pattern, seed});
}

/// Returns how many of columns × rows equal cells hold exactly one point.
std::size_t cells_with_one(const std::vector<glm::dvec2>& points, std::uint32_t columns, std::uint32_t rows) {
  std::vector<int> hits(std::size_t{columns} * rows, 0);
  for (const glm::dvec2& q : points) {
    ++hits[static_cast<std::size_t>(q.y * rows) * columns + static_cast<std::size_t>(q.x * columns)];
  }
  std::size_t ones = 0;
  for (const int hit : hits) ones += hit == 1 ? 1 : 0;
  return ones;
}

TEST(SamplePatterns, EveryCountGivesItsNumberOfPointsInTheUnitSquare) {
  for (const SamplePattern pattern :
       {SamplePattern::rows, SamplePattern::grid, SamplePattern::sobol, SamplePattern::jittered, SamplePattern::rgss}) {
    for (std::uint32_t count = 1; count <= kMaxLightSamples; count = count < 40 ? count + 1 : count * 2 - 7) {
      const auto points = samples(count, pattern, 3);
      const bool rounds = pattern == SamplePattern::rows || pattern == SamplePattern::grid;
      const auto rows = static_cast<std::uint32_t>(std::lround(std::sqrt(count)));
      const auto squares = (count + 3) / 4,
                 of_squares = static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(squares))));
      const std::uint32_t expected = rounds ? rows * ((count + rows - 1) / rows)
                                     : pattern == SamplePattern::rgss
                                         ? 4 * of_squares * ((squares + of_squares - 1) / of_squares)
                                         : count;
      EXPECT_EQ(points.size(), expected) << name_of(pattern) << ' ' << count;
      for (const glm::dvec2& q : points) {
        EXPECT_TRUE(q.x >= 0 && q.x < 1 && q.y >= 0 && q.y < 1) << name_of(pattern) << ' ' << count;
      }
    }
  }
}

TEST(SamplePatterns, GridIsCellCentredAndRowMajor) {
  const auto points = samples(6, SamplePattern::grid);  // round(√6) = 2 rows of 3
  ASSERT_EQ(points.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    const std::size_t column = i % 3, row = i / 3;
    EXPECT_DOUBLE_EQ(points[i].x, (static_cast<double>(column) + 0.5) / 3);
    EXPECT_DOUBLE_EQ(points[i].y, (static_cast<double>(row) + 0.5) / 2);
  }
}

TEST(SamplePatterns, RowsShiftEachRowByItsOwnFraction) {
  const auto points = samples(4096, SamplePattern::rows);
  EXPECT_EQ(cells_with_one(points, 64, 64), 4096u);
  std::set<double> shifts;
  for (std::uint32_t row = 0; row < 64; ++row) {
    const double shift = row_shift_of(row);
    EXPECT_GT(shift, -0.5);
    EXPECT_LT(shift, 0.5);
    // A multiple of the golden ratio's fraction, rounded to 2⁻¹⁶: half of that is lost for each row.
    const double off = shift - row * (std::numbers::phi - 1);
    EXPECT_LE(std::abs(off - std::round(off)), row * 0x1p-17);
    EXPECT_EQ(shift, static_cast<double>(static_cast<float>(shift)));
    shifts.insert(shift);
    for (std::uint32_t column = 0; column < 64; ++column) {
      EXPECT_EQ(points[row * 64 + column].x, (column + 0.5 + shift) / 64);
    }
  }
  EXPECT_EQ(shifts.size(), 64u);
  EXPECT_EQ(row_shift_of(0), 0.0) << "a single sample is the light's centre";
  double gap = 0, previous = -0.5;  // the set is sorted: the golden ratio leaves no gap above 3 / 64 of a cell
  for (const double shift : shifts) gap = std::max(gap, shift - std::exchange(previous, shift));
  EXPECT_LT(gap, 3.0 / 64);
}

TEST(SamplePatterns, SobolIsANetInBase2WhateverTheSeed) {
  // A (0, m, 2)-net: each of 2^a × 2^(m − a) equal cells holds exactly one of the 2^m points. Owen scrambling preserves
  // this.
  for (const std::uint32_t seed : {0u, 1u, 77u, 0xffffffffu}) {
    for (std::uint32_t m = 0; m <= 12; ++m) {
      const auto points = samples(1u << m, SamplePattern::sobol, seed);
      for (std::uint32_t a = 0; a <= m; ++a) {
        EXPECT_EQ(cells_with_one(points, 1u << a, 1u << (m - a)), std::size_t{1} << m) << seed << ' ' << m << ' ' << a;
      }
    }
  }
}

TEST(SamplePatterns, JitteredHasOnePointInEachStratum) {
  EXPECT_EQ(cells_with_one(samples(256, SamplePattern::jittered, 5), 16, 16), 256u);
  EXPECT_EQ(cells_with_one(unit_square_samples({0, 3, 7, SamplePattern::jittered, 5}), 7, 3), 21u);
  const auto prime =
      samples(7, SamplePattern::jittered, 5);  // 3 rows of 2, 2 and 3 points, with heights in that proportion
  for (std::size_t i = 0; i < 7; ++i) {
    const double below = i < 2 ? 0 : i < 4 ? 2 : 4, above = i < 2 ? 2 : i < 4 ? 4 : 7;
    EXPECT_GE(prime[i].y, below / 7);
    EXPECT_LT(prime[i].y, above / 7);
  }
}

/// Points fill their strata evenly: each tenth of a stratum, across and along, holds 410 ± 19 of 4096 points.
TEST(SamplePatterns, JitteredFillsItsStrata) {
  std::array<int, 10> across{}, along{};
  for (const glm::dvec2& q : samples(4096, SamplePattern::jittered, 5)) {
    const glm::dvec2 at = 64.0 * q - glm::floor(64.0 * q);
    ++across.at(static_cast<std::size_t>(10 * at.x));
    ++along.at(static_cast<std::size_t>(10 * at.y));
  }
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_NEAR(across.at(i), 410, 5 * 19) << i;
    EXPECT_NEAR(along.at(i), 410, 5 * 19) << i;
  }
}

/// 8 x 8 squares of four points: 32 columns and 32 rows of eight points each, one point in each of 16 x 16 cells; the
/// four points of a square are turned into each other by right angles.
TEST(SamplePatterns, TurnedSquaresStandInThirtyTwoColumns) {
  const auto points = samples(256, SamplePattern::rgss);
  EXPECT_EQ(cells_with_one(points, 16, 16), 256u);
  std::map<double, int> columns, rows;
  for (const glm::dvec2& q : points) {
    ++columns[q.x];
    ++rows[q.y];
  }
  EXPECT_EQ(columns.size(), 32u);
  EXPECT_EQ(rows.size(), 32u);
  for (const auto& [x, count] : columns) EXPECT_EQ(count, 8) << x;
  for (const auto& [y, count] : rows) EXPECT_EQ(count, 8) << y;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec2 middle = (glm::floor(8.0 * points[i]) + 0.5) / 8.0, from = points[i] - middle,
                     turned = middle + glm::dvec2(-from.y, from.x);
    EXPECT_EQ(std::ranges::count(std::span(points).subspan(i / 4 * 4, 4), turned), 1) << i;
  }
  EXPECT_EQ(unit_square_samples({0, 3, 7, SamplePattern::rgss, 0}).size(), 4u * 2 * 4);
  EXPECT_THROW(unit_square_samples({0, 1, 4096, SamplePattern::rgss, 0}), UsageError);
}

TEST(SamplePatterns, SeedsDecideAndRepeat) {
  for (const SamplePattern pattern : {SamplePattern::sobol, SamplePattern::jittered}) {
    EXPECT_EQ(samples(100, pattern, 4), samples(100, pattern, 4));
    EXPECT_NE(samples(100, pattern, 4), samples(100, pattern, 5));
  }
}

TEST(SamplePatterns, RefusesCountsItCannotDo) {
  EXPECT_THROW(samples(0, SamplePattern::rows), UsageError);
  EXPECT_THROW(samples(4097, SamplePattern::sobol), UsageError);
  EXPECT_THROW(unit_square_samples({1, 65536, 65537, SamplePattern::grid, 0}), UsageError);
  EXPECT_THROW(unit_square_samples({1, 0, 4, SamplePattern::grid, 0}), UsageError);
  try {
    samples(0, SamplePattern::rows);
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "light samples: 0 requested; 1 to 4096 are possible");
  }
}

}  // namespace
}  // namespace penumbra::visibility
