// SPDX-License-Identifier: Apache-2.0
#include "compare/error_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace penumbra::compare {
namespace {

int darkness(const Color8& c) {
  return 3 * 255 - c[0] - c[1] - c[2];
}

TEST(ErrorColor, WhiteIsRight) {
  EXPECT_EQ(error_color(0, 0.1), (Color8{255, 255, 255}));
}

TEST(ErrorColor, BlueIsTooBrightRedTooDark) {
  for (const double error : {0.001, 0.01, 0.05, 0.1, 0.7}) {
    const Color8 bright = error_color(error, 0.1), dark = error_color(-error, 0.1);
    EXPECT_GT(bright[2], bright[0]) << error;
    EXPECT_GT(dark[0], dark[2]) << error;
  }
}

TEST(ErrorColor, DeepensWithTheSizeUpToTheLimit) {
  for (const double sign : {1.0, -1.0}) {
    int before = -1;
    for (double error = 0; error <= 0.1001; error += 0.005) {
      const int now = darkness(error_color(sign * error, 0.1));
      EXPECT_GT(now, before) << sign * error;
      before = now;
    }
    EXPECT_EQ(error_color(sign * 0.1, 0.1), error_color(sign * 1.0, 0.1));
  }
}

TEST(ErrorColor, AQuarterOfTheLimitStandsHalfWay) {
  EXPECT_EQ(error_color(0.25, 1), (Color8{90, 163, 206}));  // the middle of the five blues
  EXPECT_EQ(error_color(-0.25, 1), (Color8{240, 130, 95}));
}

TEST(ErrorScale, TakesTheNextRoundNumber) {
  EXPECT_EQ(error_scale_limit(0), 0.01);
  EXPECT_EQ(error_scale_limit(0.01), 0.01);
  EXPECT_EQ(error_scale_limit(0.0101), 0.02);
  EXPECT_EQ(error_scale_limit(0.3), 0.5);
  EXPECT_EQ(error_scale_limit(0.51), 1);
  EXPECT_EQ(error_scale_limit(7), 1);
}

TEST(Pictures, BackgroundIsNeitherErrorNorV) {
  visibility::ViewSamples samples;
  samples.width = 3;
  samples.height = 1;
  samples.triangle = {0, -1, 1};
  const std::vector<float> v{0.5f, 1.0f, 2.0f}, reference{0.25f, 0.0f, 2.0f};
  const Image8 error = error_picture(samples, v, reference, 1);
  EXPECT_EQ(error.pixels, (std::vector<Color8>{{90, 163, 206}, kBackgroundColor, {255, 255, 255}}));
  const Image8 grey = visibility_picture(samples, v);
  EXPECT_EQ(grey.pixels, (std::vector<Color8>{{128, 128, 128}, kBackgroundColor, {255, 255, 255}}));
}

TEST(Exposure, PutsThe99thPercentileBelowWhite) {
  EXPECT_EQ(auto_exposure({}), 1);
  EXPECT_EQ(auto_exposure(std::vector<glm::vec3>(5, glm::vec3(0))), 1);
  // 101 pixels whose largest component is 1 … 101, and black ones: the 99th percentile of 1 … 101 is 100.
  std::vector<glm::vec3> linear(50, glm::vec3(0));
  for (int i = 101; i >= 1; --i) linear.emplace_back(0.5f, static_cast<float>(i), 0.1f);
  EXPECT_FLOAT_EQ(auto_exposure(linear), 0.009f);
  linear.emplace_back(0, 0, std::nanf(""));
  EXPECT_GT(auto_exposure(linear), 0);
}

TEST(Exposure, IsThatOfSortedPixels) {
  constexpr unsigned kSeed = 5;
  std::mt19937 random(kSeed);
  for (const std::size_t count : {1U, 2U, 99U, 100U, 101U, 5000U}) {
    std::vector<glm::vec3> linear;
    std::vector<std::uint8_t> left_out;
    std::vector<float> largest;
    for (std::size_t i = 0; i < count; ++i) {
      // Values of every exponent, some of them equal.
      const float value = std::ldexp(1 + static_cast<float>(random() % 5) / 8, static_cast<int>(random() % 250) - 125);
      linear.emplace_back(value / 2, value, value / 4);
      left_out.push_back(i > 0 && random() % 3 == 0 ? 1 : 0);
      if (left_out.back() == 0) largest.push_back(value);
    }
    std::ranges::sort(largest);
    EXPECT_EQ(auto_exposure(linear, left_out), 0.9f / largest[(largest.size() - 1) * 99 / 100])
        << count << " pixels, seed " << kSeed;
  }
}

TEST(Exposure, TakesWhatIsLeftOutWhereAllElseIsBlack) {
  const std::vector<glm::vec3> linear{{0, 3, 0}, {0, 0, 0}};
  EXPECT_FLOAT_EQ(auto_exposure(linear, std::vector<std::uint8_t>{1, 0}), 0.3f);
  EXPECT_FLOAT_EQ(auto_exposure(linear, std::vector<std::uint8_t>{1, 1}), 0.3f);
  const std::vector<glm::vec3> unknown{{0, 3, 0}, {0, std::nanf(""), 0}};
  EXPECT_EQ(auto_exposure(unknown, std::vector<std::uint8_t>{1, 0}), 1) << "not a number is not black";
}

}  // namespace
}  // namespace penumbra::compare
