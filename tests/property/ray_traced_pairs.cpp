// SPDX-License-Identifier: Apache-2.0
// Compares every pair of a small picture between the ray caster and the exact decision: away from exact zeros, Embree's
// robust mode differs only by rounding.

#include "tests/unit/ray_traced_masks.hpp"
#include "tests/unit/visibility/soups.hpp"
#include "visibility/pair_truth.hpp"

#include <gtest/gtest.h>

#include <random>

namespace penumbra::reference {
namespace {

using tests::Stage;
using visibility::PairOutcome;
using visibility::SamplePattern;
using visibility::ViewSamples;

scenes::Scene soup_over_floor(std::uint32_t seed) {
  std::mt19937 random(seed);
  scenes::Scene scene = tests::soup_over_tilted_floor(random, 60);
  std::uniform_real_distribution<double> real(-1, 1);
  const glm::dvec3 center(real(random), 3, real(random));
  scene.lights.push_back(tests::rectangle_light(center, {0.6, 0.1, 0.03}, {0.05, 0.1, 0.7}));
  if (seed % 8 == 1) scene.lights[0].shape = scenes::Disk{center, {0.1, -1, 0.2}, 0.7};
  if (seed % 8 == 5) scene.lights[0].shape = scenes::Ellipse{center, {0.6, 0.1, 0.03}, {0.05, 0.1, 0.3}};
  if (seed % 4 == 2) scene.lights[0].shape = scenes::Polygon{{{-0.5, 3, -0.5}, {0.7, 3, -0.4}, {0.1, 3, 0.8}}};
  if (seed % 8 == 3) scene.lights[0].shape = scenes::Sphere{center, 0.6};
  if (seed % 8 == 7) scene.lights[0].shape = scenes::Sun{-center, seed % 16 == 7 ? 25.0 : 0.0};
  return scene;
}

class RayTracedPairs : public testing::TestWithParam<std::uint32_t> {};

TEST_P(RayTracedPairs, AgreeWithTheExactDecision) {
  const Stage setup(soup_over_floor(GetParam()), 48, 48, {32, 0, 0, SamplePattern::jittered, GetParam()});
  const tests::Masks masks = tests::trace(setup);
  std::size_t pairs = 0, differing = 0, blocked = 0, horizon = 0, zeros = 0;
  for (std::size_t pixel = 0; pixel < setup.samples.size(); ++pixel) {
    if (setup.samples.triangle[pixel] == ViewSamples::kBackground) continue;
    for (std::uint32_t j = 0; j < setup.light.sample_count(); ++j) {
      const auto truth = visibility::decide_pair(setup.floats, setup.samples, pixel, setup.light, j);
      ++pairs;
      blocked += truth.outcome == PairOutcome::blocked ? 1 : 0;
      horizon += truth.outcome == PairOutcome::horizon ? 1 : 0;
      zeros += truth.zero_predicate ? 1 : 0;
      const bool differs = (truth.outcome == PairOutcome::visible) != masks.visible(pixel, j);
      differing += differs ? 1 : 0;
      EXPECT_FALSE(differs && truth.outcome == PairOutcome::horizon) << "the horizon is decided exactly";
    }
  }
  RecordProperty("pairs", static_cast<int>(pairs));
  RecordProperty("differing", static_cast<int>(differing));
  EXPECT_GT(pairs, 20000u);
  EXPECT_GT(blocked, 2000u);
  EXPECT_GT(horizon, 200u);
  EXPECT_LE(differing, pairs / 10000) << differing << " of " << pairs << ", " << zeros << " with a zero";
}

INSTANTIATE_TEST_SUITE_P(Seeds, RayTracedPairs, testing::Range(0u, 16u));

}  // namespace
}  // namespace penumbra::reference
