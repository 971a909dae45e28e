// SPDX-License-Identifier: Apache-2.0
// Tests bounds of depth lists as tightly as they can be: how few steps deep-penumbra keeps, where its rays begin, and
// from which difference on layered-attenuation keeps two surfaces apart.

#include "maps/products/lists/penumbra_events.hpp"
#include "maps/sampling/methods.hpp"
#include "selftest/crowd.hpp"
#include "selftest/list_checks.hpp"
#include "tests/analytic/maps/fixture.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace penumbra::tests {
namespace {

class MapListBounds : public MapsTest {};

// Lists have as few steps as the bound allows, counted in 64 samples: a piece continues while its values lie within
// twice the bound, or within the bound if one of them is the whole light or none of it.
TEST_F(MapListBounds, StepsAreAsFewAsTheBoundAllows) {
  constexpr std::uint32_t kSize = 24, kSamples = 64;
  const Stage stage(selftest::crowd(false, false), 4, 4, light_samples(kSamples));
  selftest::ListSource made(device(), stage, kSize);
  const auto made_with = [&](double bound) {
    maps::PenumbraEvents product(device(), bound);
    product.make(*made.source);
    std::vector<std::uint32_t> words(product.buffer().bytes() / sizeof(std::uint32_t));
    product.buffer().read<std::uint32_t>(words);
    return words;
  };
  constexpr std::size_t kTexels = std::size_t{kSize} * kSize;
  const std::vector<std::uint32_t> all = made_with(0);
  for (const double bound : {0.02, 0.05, 0.1}) {
    const std::vector<std::uint32_t> words = made_with(bound);
    const auto tolerance = static_cast<int>(2 * bound * kSamples);
    for (std::size_t texel = 0; texel < kTexels; ++texel) {
      int low = kSamples, high = kSamples;
      std::uint32_t pieces = 1;  // the first piece, fully lit, has no step
      for (std::uint32_t k = all[texel]; k < all[texel + 1]; ++k) {
        const float v = std::bit_cast<float>(all[kTexels + 2 + 2 * std::size_t{k}]);
        const auto visible = static_cast<int>(std::lround(v * static_cast<float>(kSamples)));
        low = std::min(low, visible);
        high = std::max(high, visible);
        const int off = high == kSamples ? 2 * (high - low) : low == 0 ? 2 * high : high - low;
        if (off <= tolerance) continue;
        low = high = visible;
        ++pieces;
      }
      EXPECT_EQ(words[texel + 1] - words[texel], pieces - 1) << "texel " << texel << ", bound " << bound;
    }
  }
}

// A board 1 % behind the nearest caster: rays must be followed from there or nearer.
TEST_F(MapListBounds, WhatIsJustBehindTheNearestCasterIsInItsShadow) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, -3});
  add_quad(scene, {0, 2, 0}, {0.8, 0, 0}, {0, 0, 0.8});
  add_quad(scene, {0, 1.97, 0}, {0.5, 0, 0}, {0, 0, 0.5});
  scene.lights.push_back(ceiling_light(5, 0.5));
  scene.cameras.push_back(camera({0, 0.5, 2}, {0, 1.5, 0}, 60));
  const auto grid = [](const visibility::SceneFloats& floats, const visibility::PinholeCamera& /*camera*/) {
    visibility::ViewSamples samples;
    samples.width = samples.height = 8;
    for (std::uint32_t i = 0; i < 64; ++i) {
      samples.triangle.push_back(4);
      const std::uint32_t column = i % 8, row = i / 8;
      samples.p.emplace_back(glm::dvec3(0.1 * column - 0.35, 1.97, 0.1 * row - 0.35) - floats.origin);
      samples.n.emplace_back(0, 1, 0);
      samples.depth.push_back(1);
      samples.facing.push_back(1);
    }
    return samples;
  };
  const Stage stage(scene, 8, 8, light_samples(4), grid);
  for (const float v : run(maps::make_deep_penumbra, stage, {{"size", "256"}}).visibility) EXPECT_EQ(v, 0.0F);
}

// A board 0.2 above one half of a floor that is 5 below the light: the depths differ by 0.04 of their value. With a
// smaller epsilon, whatever its value, board and floor stay apart; with a larger one the floor in the shadow is taken
// for the board.
TEST_F(MapListBounds, EpsilonActsFromTheGapOn) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -2});
  add_quad(scene, {-2, 0.2, 0}, {2, 0, 0}, {0, 0, 2.5}).receives_shadow = false;
  scene.lights.push_back(ceiling_light(5, 0.4));
  scene.cameras.push_back(camera({0, 0.1, 3}, {0, 0, 0}, 60));  // looks from below the board
  const Stage stage(scene, 48, 48, light_samples(36));
  const auto with = [&](const char* epsilon) {
    return run(maps::make_layered_attenuation, stage, {{"size", "128"}, {"bias", "0"}, {"epsilon", epsilon}});
  };
  const Masks small = with("0.01"), below = with("0.0395"), above = with("0.0405");
  EXPECT_EQ(small.visibility, below.visibility);
  std::size_t umbra = 0, leaks = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (stage.samples.triangle[i] < 0 || small.visibility[i] > 0) continue;
    ++umbra;
    leaks += above.visibility[i] > 0.9F ? 1 : 0;
  }
  EXPECT_GT(umbra, 50U);
  EXPECT_GT(leaks, umbra * 9 / 10);
}

}  // namespace
}  // namespace penumbra::tests
