// SPDX-License-Identifier: Apache-2.0
// Tests the weights of a textured light's samples: their sum is exactly 1, each is in proportion to the luminance of
// the texel at the sample, and a constant texture gives the same bytes as no texture.

#include "base/error.hpp"
#include "tests/unit/scenes/support.hpp"
#include "tests/unit/textured_lights_support.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/masks/visible_share.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace penumbra::visibility {
namespace {

using tests::texture_of;

Light light_with(const scenes::Texture& texture, const SampleRequest& request) {
  return make_light(tests::board_under_light(texture), 0, glm::dvec3(0), request);
}

std::vector<glm::dvec2> centred_rows(std::uint32_t count) {
  std::vector<glm::dvec2> coordinates;
  for (std::uint32_t i = 0; i < count; ++i) coordinates.emplace_back((2.0 * i + 1) / count - 1, 0.0);
  return coordinates;
}

TEST(TexturedLightWeights, AddUpToOneInAnyOrder) {
  constexpr unsigned kSeed = 11;
  std::mt19937 random(kSeed);
  std::exponential_distribution<float> brightness(1.0f);
  for (const std::uint32_t count : {1u, 3u, 225u, 1000u, 4096u}) {
    const auto texture = texture_of(64, 64, [&](std::uint32_t x, std::uint32_t) {
      return glm::vec3(brightness(random) * (x == 7 ? 1e6f : 1.0f));  // as bright as a sun among clouds
    });
    Light light = light_with(texture, {count, 0, 0, SamplePattern::sobol, 5});
    std::vector<double> shuffled = light.weights;
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(std::accumulate(shuffled.begin(), shuffled.end(), 0.0), 1.0) << count << ", seed " << kSeed;
      std::shuffle(shuffled.begin(), shuffled.end(), random);
    }
    double sum = 0;
    for (const glm::dvec2& st : light.coordinates) sum += light.texture->luminance[light.texture->texel_at(st)];
    for (std::size_t j = 0; j < light.weights.size(); ++j) {
      const double expected = light.texture->luminance[light.texture->texel_at(light.coordinates[j])] / sum;
      ASSERT_NEAR(light.weights[j], expected, 0x1p-40) << j;
    }
  }
}

TEST(TexturedLightWeights, OfAConstantTextureGiveTheBytesOfNone) {
  // Tries every number of visible samples for each number of samples up to 300, and for some larger ones.
  const auto texture = make_light_texture(tests::constant_texture(5, 3, glm::vec3(0.1f, 0.7f, 0.3f)));
  std::vector<std::uint32_t> counts(300);
  std::iota(counts.begin(), counts.end(), 1u);
  counts.insert(counts.end(), {441, 625, 1000, 1023, 1681, 2047, 3025, 4095, 4096});
  for (const std::uint32_t count : counts) {
    const std::vector<double> weights = sample_weights(texture, centred_rows(count), "light");
    double sum = 0;
    for (std::uint32_t visible = 1; visible <= count; ++visible) {
      sum += weights[visible - 1];
      ASSERT_EQ(static_cast<float>(sum), static_cast<float>(visible) / static_cast<float>(count)) << count;
    }
  }
}

TEST(TexturedLightWeights, TexelZeroLiesAtTheLeftAndTheTop) {
  // Numbers 3 × 2 texels by their red value. halfU points to the right, halfV upward.
  const auto texture =
      texture_of(3, 2, [](std::uint32_t x, std::uint32_t y) { return glm::vec3(static_cast<float>(1 + x + 3 * y)); });
  const Light light = light_with(texture, {6, 2, 3, SamplePattern::grid, 0});
  ASSERT_EQ(light.sample_count(), 6u);
  for (std::size_t j = 0; j < 6; ++j) {
    const glm::dvec2 st = light.coordinates[j];
    const float expected = (st.x < -0.5 ? 1.0f : st.x < 0.5 ? 2.0f : 3.0f) + (st.y > 0 ? 0.0f : 3.0f);
    EXPECT_EQ(light.sample_colors[j].r, expected) << st.x << ", " << st.y;
    EXPECT_NEAR(light.weights[j], static_cast<double>(expected) / 21, 1e-15);
  }
  EXPECT_EQ(light.texture->texel_at({-1, 1}), 0u);
  EXPECT_EQ(light.texture->texel_at({1, 1}), 2u);
  EXPECT_EQ(light.texture->texel_at({-1, -1}), 3u);
  EXPECT_EQ(light.texture->texel_at({2, -2}), 5u);
  EXPECT_DOUBLE_EQ(light.texture->mean_luminance, 3.5);
}

TEST(TexturedLightWeights, AreLuminanceNotColour) {
  const auto texture = texture_of(3, 1, [](std::uint32_t x, std::uint32_t) {
    return x == 0 ? glm::vec3(1, 0, 0) : x == 1 ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1);
  });
  const Light light = light_with(texture, {3, 1, 3, SamplePattern::grid, 0});
  EXPECT_NEAR(light.weights[0], 0.2126, 1e-15);
  EXPECT_NEAR(light.weights[1], 0.7152, 1e-15);
  EXPECT_NEAR(light.weights[2], 0.0722, 1e-15);
  const std::vector<std::uint32_t> mask{0b101};
  EXPECT_FLOAT_EQ(visible_share(light, mask), 0.2848f);
}

TEST(TexturedLightWeights, SamplesThatSeeOnlyBlackTexelsAreRefused) {
  // One bright texel of 64, in the corner; none of the four samples lies on it.
  const auto texture =
      texture_of(8, 8, [](std::uint32_t x, std::uint32_t y) { return glm::vec3(x + y == 0 ? 1.0f : 0.0f); });
  test::expect_error(ExitCode::input, "all 4 light samples lie on black texels of its 8x8 texture; take more", [&] {
    (void)light_with(texture, {4, 0, 0, SamplePattern::grid, 0});
  });
  EXPECT_EQ(light_with(texture, {64, 0, 0, SamplePattern::grid, 0}).weights[56], 1.0);  // the last row is the topmost
}

TEST(TexturedLightWeights, WithoutATextureThereAreNone) {
  const Light light = make_light(tests::board_under_light({}), 0, glm::dvec3(0), {});
  EXPECT_TRUE(light.weights.empty());
  EXPECT_TRUE(light.sample_colors.empty());
  EXPECT_FALSE(light.texture.has_value());
}

}  // namespace
}  // namespace penumbra::visibility
