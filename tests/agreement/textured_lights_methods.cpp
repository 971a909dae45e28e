// SPDX-License-Identifier: Apache-2.0
// Tests all methods under textured lights: the same pairs as without texture, V from the weights of the visible
// samples, and beauty.

#include "compare/beauty.hpp"
#include "maps/sampling/methods.hpp"
#include "tests/agreement/support.hpp"
#include "tests/unit/textured_lights_support.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace penumbra::tests {
namespace {

using visibility::SamplePattern;
using visibility::SampleRequest;

class TexturedLightMethods : public DeviceTest {
 protected:
  using Make = std::function<std::unique_ptr<visibility::Method>()>;
  /// The mask methods.
  static std::vector<Make> makers() {
    return {[] { return reference::make_ray_traced({}); },
            [] {
              return vsm::make_view_sample(device(), {{"engine", "vulkan"}});
            },
            [] {
              return vsm::make_view_sample(device(), {{"engine", "native"}});
            },
            [] {
              return maps::make_accumulate(device(), {{"size", "64"}});
            }};
  }
  static Masks run_on(const Make& make, const Stage& stage, std::uint32_t rows = 0) {
    const auto method = make();
    return run(*method, stage.floats, stage.light, stage.samples, rows);
  }
  static Stage stage_with(std::optional<scenes::Texture> texture, const SampleRequest& request) {
    return {board_under_light(std::move(texture)), 40, 30, request};
  }
};

scenes::Texture random_texture(std::uint32_t width, std::uint32_t height, unsigned seed) {
  std::mt19937 random(seed);
  const auto level = [&] { return static_cast<float>(random() % 4) / 3.0f; };
  return texture_of(width, height, [&](std::uint32_t x, std::uint32_t y) {
    return x + y == 0 ? glm::vec3(1) : glm::vec3(level(), level(), level());
  });
}

TEST_F(TexturedLightMethods, PairsStayAsTheyAreAndVAddsWeights) {
  const SampleRequest request{200, 0, 0, SamplePattern::jittered, 7};
  const Stage plain = stage_with({}, request), textured = stage_with(random_texture(9, 5, 1), request);
  for (const Make& make : makers()) {
    const Masks without = run_on(make, plain), with = run_on(make, textured), in_bands = run_on(make, textured, 7);
    EXPECT_EQ(with.words, without.words);
    EXPECT_EQ(with.visibility, in_bands.visibility);
    int part = 0;
    for (std::size_t i = 0; i < with.visibility.size(); ++i) {
      double v = 0;
      for (std::uint32_t j = textured.light.sample_count(); j-- > 0;) {
        if (with.visible(i, j)) v += textured.light.weights[j];
      }
      ASSERT_EQ(with.visibility[i], static_cast<float>(v)) << i;
      part += v > 0 && v < 1 ? 1 : 0;
    }
    EXPECT_GT(part, 50);
  }
}

TEST_F(TexturedLightMethods, AConstantTextureGivesTheBytesOfNone) {
  for (const std::uint32_t count : {64u, 225u}) {
    const SampleRequest request{count, 0, 0, SamplePattern::rows, 0};
    const Stage plain = stage_with({}, request);
    const Stage textured = stage_with(constant_texture(6, 11, glm::vec3(0.1f, 0.5f, 0.9f)), request);
    for (const Make& make : makers()) EXPECT_EQ(run_on(make, textured).visibility, run_on(make, plain).visibility);
  }
}

/// Returns the scene with only one half of its light: the half at −axis or +axis (side −1 or 1), where axis is halfU or
/// halfV.
scenes::Scene half_light_scene(glm::dvec3 scenes::Rectangle::*axis, int side) {
  scenes::Scene scene = board_under_light({});
  auto& rectangle = std::get<scenes::Rectangle>(scene.lights[0].shape);
  rectangle.*axis *= 0.5;
  rectangle.center += static_cast<double>(side) * rectangle.*axis;
  return scene;
}

// Sixteen by sixteen samples at the centres of cells, of which eight by sixteen are on a half: exactly the points of
// the half light's own samples, so that V is equal, not just close.
const SampleRequest kWhole{256, 16, 16, SamplePattern::grid, 0}, kHalfU{128, 16, 8, SamplePattern::grid, 0};

TEST_F(TexturedLightMethods, HalfBlackIsHalfALight) {
  for (const int side : {-1, 1}) {
    const auto texture = texture_of(
        2, 1, [&](std::uint32_t x, std::uint32_t) { return glm::vec3((x == 0) == (side < 0) ? 1.0f : 0.0f); });
    const Stage whole = stage_with(texture, kWhole),
                half(half_light_scene(&scenes::Rectangle::half_u, side), 40, 30, kHalfU);
    for (const Make& make :
         {makers()[0], makers()[1], makers()[2]}) {  // accumulate's maps are fitted to the whole light
      EXPECT_EQ(run_on(make, whole).visibility, run_on(make, half).visibility);
    }
  }
}

std::vector<glm::vec3> beauty_of(const Stage& stage, const compare::LightVisibility& seen) {
  const std::vector<glm::dvec3> colors(stage.floats.object.empty() ? 0 : 8, glm::dvec3(0.5));
  return compare::integrate_beauty({stage.floats, stage.samples, colors, std::span(&stage.light, 1)}, {&seen, 1});
}

TEST_F(TexturedLightMethods, BeautyTakesEachSamplesColour) {
  // Red above, blue below: the red channel is that of a white light whose lower half is hidden, the blue channel that
  // of one whose upper half is hidden, up to the order of sums in double and one rounding to float.
  const auto texture =
      texture_of(1, 2, [](std::uint32_t, std::uint32_t y) { return y == 0 ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1); });
  const Stage colored = stage_with(texture, kWhole), white = stage_with(constant_texture(1, 1, glm::vec3(1)), kWhole);
  const Masks seen = trace(colored);
  const auto half_of = [&](std::size_t first_word) {  // keeps half of eight words, whose rows go from t = −1 upward
    std::vector<std::uint32_t> words = seen.words;
    for (std::size_t i = 0; i < words.size(); ++i) words[i] &= i % 8 / 4 == first_word ? 0xffffffffu : 0u;
    return words;
  };
  const std::vector<std::uint32_t> upper = half_of(1), lower = half_of(0), all(seen.words.size(), 0xffffffffu);
  std::vector<std::uint32_t> upper_all = all;
  for (std::size_t i = 0; i < all.size(); ++i) upper_all[i] = i % 8 / 4 == 1 ? 0xffffffffu : 0u;
  const std::vector<float> third(colored.samples.size(), 1.0f / 3);
  const auto masked = beauty_of(colored, {.masks = seen.words}), scaled = beauty_of(colored, {.visibility = third});
  const auto red = beauty_of(white, {.masks = upper}), blue = beauty_of(white, {.masks = lower});
  const auto all_red = beauty_of(white, {.masks = upper_all});
  int part = 0;
  for (std::size_t i = 0; i < masked.size(); ++i) {
    ASSERT_FLOAT_EQ(masked[i].r, red[i].r);
    ASSERT_FLOAT_EQ(masked[i].b, blue[i].r);
    ASSERT_EQ(masked[i].g, 0);
    ASSERT_FLOAT_EQ(scaled[i].r, all_red[i].r / 3);
    part += masked[i].r > 0 && masked[i].r < 0.9f * all_red[i].r ? 1 : 0;
  }
  EXPECT_GT(part, 20);
}

TEST_F(TexturedLightMethods, TheBodyShowsThePictureUprightToWhoStandsBeforeIt) {
  scenes::Scene scene;
  add_object(scene, "body", quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0})).emits = 0;
  scene.lights.push_back(rectangle_light({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));  // emits toward +z
  scene.lights[0].radiance = glm::dvec3(2);
  scene.lights[0].texture = texture_of(4, 4, [](std::uint32_t x, std::uint32_t y) {
    return glm::vec3(static_cast<float>(x) + 1, static_cast<float>(y) + 1, 1);
  });
  scene.cameras.push_back(camera({0, 0, 4}, {0, 0, 0}, 90));  // sees y from −4 to 4: a pixel is half a unit
  const Stage stage(scene, 16, 16, {16, 4, 4, SamplePattern::grid, 0});
  const std::vector<float> all(256, 1.0f);
  const auto picture = beauty_of(stage, {.visibility = all});
  for (std::uint32_t y = 0; y < 4; ++y) {
    for (std::uint32_t x = 0; x < 4; ++x) {
      EXPECT_EQ(picture[(y + 6) * 16 + x + 6], 2.0f * glm::vec3(x + 1, y + 1, 1)) << x << ", " << y;
    }
  }
}

}  // namespace
}  // namespace penumbra::tests
