// SPDX-License-Identifier: Apache-2.0
// Tests the measures of visible errors: share of visible differences, banding and FLIP.
#include "compare/eye.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace penumbra::compare {
namespace {

// 3 × 2 pixels, errors (0, 1/8, 1/8; 1/512, −1/8, 0) all exact in float.
struct Errors {
  std::vector<float> reference{0.5F, 0.5F, 0.5F, 0.5F, 0.5F, 1};
  std::vector<float> v{0.5F, 0.625F, 0.625F, 0.5F + 1 / 512.0F, 0.375F, 1};
  std::vector<std::uint32_t> judged{0, 1, 2, 3, 4, 5}, penumbra{0, 1, 2, 3, 4};
};

TEST(EyeErrorTest, CountsWhatAByteShowsAndStepsBetweenNeighbours) {
  const Errors e;
  const EyeError eye = eye_error({e.v, e.reference, e.judged}, e.penumbra, 3).value();
  EXPECT_DOUBLE_EQ(eye.over255, 3.0 / 6) << "1/512 is below a byte's step";
  // Pairs side by side: 0–1, 1–2, 3–4. Pairs one above the other: 0–3, 1–4. Not 2–5, of which one end is outside the
  // penumbra, nor 2–3, which are in two rows.
  const double squares =
      std::pow(1 / 8.0, 2) + 0 + std::pow(1 / 512.0 + 1 / 8.0, 2) + std::pow(1 / 512.0, 2) + 1 / 16.0;
  EXPECT_DOUBLE_EQ(*eye.banding, std::sqrt(squares / 5));
  const std::vector<std::uint32_t> apart{0, 2, 4};
  EXPECT_FALSE(eye_error({e.v, e.reference, e.judged}, apart, 3)->banding.has_value());
  EXPECT_FALSE(eye_error({e.v, e.reference, {}}, {}, 3).has_value());
}

TEST(RangeErrorTest, EachPixelIsInTheRangeOfItsSize) {
  const Errors e;
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> sizes{0, 3.99F, 4, kNone, 1e30F, 16};
  const auto ranges = range_errors(e.v, e.reference, e.judged, sizes);
  ASSERT_EQ(ranges.size(), 4U);
  EXPECT_EQ(ranges[0].pixels, 2U);
  EXPECT_DOUBLE_EQ(ranges[0].error->rmse, std::sqrt(1 / 64.0 / 2));
  EXPECT_EQ(ranges[1].pixels, 1U);
  EXPECT_DOUBLE_EQ(ranges[1].error->bias, 0.125);
  EXPECT_EQ(ranges[2].pixels, 1U);
  EXPECT_EQ(ranges[2].error->rmse, 0);
  EXPECT_EQ(ranges[3].pixels, 1U);
  EXPECT_TRUE(std::isinf(ranges[3].to));
  EXPECT_EQ(ranges[3].from, 64);
}

TEST(SeparationTest, IsWhatIsLeftOfTheBeautysErrorWithoutThatOfV) {
  // ∫GV is 1 and 3; V · ∫G is 2 and 3 with the true V, 2.5 and 2 with the method's V.
  const std::vector<glm::vec3> reference{{1, 1, 1}, {3, 3, 3}}, separated{{2, 2, 2}, {3, 3, 3}},
      method{{2.5, 2.5, 2.5}, {2, 2, 2}};
  const std::vector<std::uint32_t> pixels{0, 1};
  const Separation found = separation({method, separated, reference}, pixels).value();
  EXPECT_NEAR(found.alone.relative_rmse, std::sqrt(0.5) / 2, 1e-7);
  EXPECT_NEAR(found.alone.relative_bias, 0.25, 1e-7);
  EXPECT_NEAR(found.of_v.relative_rmse, std::sqrt((0.25 + 1) / 2) / 2, 1e-7);
  EXPECT_NEAR(found.of_v.relative_bias, (0.5 - 1) / 4, 1e-7);
  EXPECT_FALSE(separation({method, separated, reference}, {}).has_value());
}

Image8 plain(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  return {9, 7, std::vector<Color8>(63, {r, g, b})};
}

/// Pictures of one colour have no edges: FLIP is the redistributed HyAB^0.7 of two Hunt-adjusted colours. L*a*b* of
/// sRGB's primaries under D65, from tables: green 87.73, −86.18, 83.18; blue 32.30, 79.19, −107.86.
TEST(FlipTest, OfPlainPicturesIsTheDifferenceOfTwoColors) {
  const auto hunted = [](double l, double a, double b) { return std::array{l, l / 100 * a, l / 100 * b}; };
  const auto green = hunted(87.7347, -86.1827, 83.1793), blue = hunted(32.2970, 79.1875, -107.8602);
  const double largest = std::pow(green[0] - blue[0] + std::hypot(green[1] - blue[1], green[2] - blue[2]), 0.7);
  const auto expected = [&](double hyab) {
    const double power = std::pow(hyab, 0.7), knee = 0.4 * largest;
    return power < knee ? 0.95 * power / knee : 0.95 + 0.05 * (power - knee) / (largest - knee);
  };
  EXPECT_NEAR(expected(100), 0.9674, 1e-4);
  EXPECT_NEAR(flip_of(plain(0, 0, 0), plain(255, 255, 255)).mean, expected(100), 2e-5);
  // Byte 128 is 0.21586 linear: L* = 116 · ∛0.21586 − 16 = 53.585.
  EXPECT_NEAR(flip_of(plain(128, 128, 128), plain(0, 0, 0)).max, expected(53.585), 2e-5);
  EXPECT_NEAR(flip_of(plain(0, 255, 0), plain(0, 0, 255)).mean, 1, 1e-6) << "the largest of all";
  EXPECT_EQ(flip_of(plain(9, 8, 7), plain(9, 8, 7)).max, 0);
  for (const float difference : flip_map(plain(9, 8, 7), plain(9, 8, 7))) EXPECT_EQ(difference, 0);
}

/// Values from tests/twins/flip.py --print 24 16: whole two-dimensional filters in numpy.
TEST(FlipTest, IsAsTheTwinHasIt) {
  Image8 first{24, 16, {}}, second = first;
  for (std::uint32_t y = 0; y < 16; ++y) {
    for (std::uint32_t x = 0; x < 24; ++x) {
      const auto byte = [](std::uint32_t value) { return static_cast<std::uint8_t>(value % 256); };
      const std::uint8_t red = byte(37 * x + 11 * y), blue = x > y ? 200 : 30;
      first.pixels.push_back({red, byte(16 * x), blue});
      second.pixels.push_back({red, byte(16 * x + (y > 3 ? 40 : 0)), blue});
    }
  }
  second.pixels[8 * 24 + 12] = {255, 255, 255};
  const Flip found = flip_of(first, second);
  EXPECT_NEAR(found.mean, 0.4622717212014244, 1e-6);
  EXPECT_NEAR(found.max, 0.9665526614811707, 1e-6);
  EXPECT_NEAR(flip_map(first, second).front(), 0.012848019565256398, 1e-6);
}

}  // namespace
}  // namespace penumbra::compare
