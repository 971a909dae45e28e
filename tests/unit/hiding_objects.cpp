// SPDX-License-Identifier: Apache-2.0
#include "reference/hiding_objects.hpp"

#include "tests/unit/ray_traced_masks.hpp"
#include "tests/unit/visibility/scenes.hpp"
#include "visibility/pair_truth.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace penumbra::reference {
namespace {

using tests::Stage;

/// A floor, a board over its left, and over its right a flap that belongs to the floor's own object; board and flap
/// overlap in the middle.
scenes::Scene board_and_flap() {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  tests::add_object(scene, "board", tests::quad({-1, 1, 0}, {1.5, 0, 0}, {0, 0, -1.5}));
  tests::add_object(scene, "flap", tests::quad({1, 1.5, 0}, {1.5, 0, 0}, {0, 0, -1.5}));
  std::ranges::replace(scene.soup.object, 2U, 0U);  // the flap becomes part of the floor's object
  scene.objects.pop_back();
  scene.lights.push_back(tests::ceiling_light(4, 0.7));
  scene.cameras.push_back(tests::camera({0, 0.9, 7}, {0, 0, 0}));
  return scene;
}

/// Tests every light sample against every triangle with exact predicates: do triangles of the pixel's own object hide
/// one, and do others?
HiddenBy by_exact_predicates(const Stage& setup, std::size_t pixel) {
  HiddenBy hidden;
  for (const bool own : {true, false}) {
    visibility::SceneFloats scene = setup.floats;
    const std::uint32_t object = scene.object[static_cast<std::size_t>(setup.samples.triangle[pixel])];
    for (std::size_t i = 0; i < scene.triangles.size(); ++i)
      scene.casts_shadow[i] &= (scene.object[i] == object) == own;
    for (std::uint32_t sample = 0; sample < setup.light.sample_count(); ++sample) {
      const auto truth = visibility::decide_pair(scene, setup.samples, pixel, setup.light, sample);
      if (truth.outcome == visibility::PairOutcome::blocked) (own ? hidden.own : hidden.other) = true;
    }
  }
  return hidden;
}

TEST(HidingObjects, AreThoseThatExactPredicatesFind) {
  const Stage setup(board_and_flap(), 40, 30);
  std::vector<std::uint32_t> pixels;
  for (std::uint32_t i = 0; i < setup.samples.size(); ++i) {
    if (setup.samples.triangle[i] != visibility::ViewSamples::kBackground && setup.samples.p[i].y < 0.1F)
      pixels.push_back(i);
  }
  const std::vector<HiddenBy> found = hiding_objects(setup.floats, setup.samples, setup.light, pixels);
  ASSERT_EQ(found.size(), pixels.size());
  int both = 0, own = 0, other = 0, missed = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const HiddenBy truth = by_exact_predicates(setup, pixels[i]);
    both += truth.own && truth.other ? 1 : 0;
    own += truth.own ? 1 : 0;
    other += truth.other ? 1 : 0;
    EXPECT_LE(found[i].own, truth.own) << pixels[i];
    EXPECT_LE(found[i].other, truth.other) << pixels[i];
    EXPECT_EQ(found[i].own || found[i].other, truth.own || truth.other) << pixels[i];
    // Only sixteen light samples are tested for both, so a second object that hides less can be missed.
    missed += found[i].own != truth.own || found[i].other != truth.other ? 1 : 0;
  }
  EXPECT_GT(both, 20);
  EXPECT_GT(own, both + 10);
  EXPECT_GT(other, both + 10);
  EXPECT_LT(missed, both / 4);
}

/// On a segment to the light, at height 4, the board is at a quarter and the flap at three eighths: penumbrae as wide
/// as 1/3 and 3/5 of the light. The nearest distance is that share of the distance to the light sample.
TEST(HidingObjects, AreSoFarAwayAndMakeSoWidePenumbrae) {
  const Stage setup(board_and_flap(), 40, 30);
  std::vector<std::uint32_t> pixels;
  for (std::uint32_t i = 0; i < setup.samples.size(); ++i) {
    const bool floor = setup.samples.triangle[i] != visibility::ViewSamples::kBackground &&
                       std::abs(setup.samples.p[i].y - setup.floats.positions[0].y) < 1e-6F;
    if (floor) pixels.push_back(i);
  }
  const std::vector<HiddenBy> found = hiding_objects(setup.floats, setup.samples, setup.light, pixels);
  int boards = 0, flaps = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (found[i].own && found[i].other) continue;
    if (!found[i].own && !found[i].other) {
      EXPECT_TRUE(std::isinf(found[i].nearest));
      EXPECT_EQ(found[i].widening, 0);
      continue;
    }
    (found[i].own ? flaps : boards) += 1;
    const double share = found[i].own ? 0.375 : 0.25;
    EXPECT_NEAR(found[i].widening, share / (1 - share), 1e-5);
    double shortest = std::numeric_limits<double>::infinity(), longest = 0;
    for (const glm::vec3& point : setup.light.points) {
      const double direction = share * glm::distance(glm::dvec3(point), glm::dvec3(setup.samples.p[pixels[i]]));
      shortest = std::min(shortest, direction);
      longest = std::max(longest, direction);
    }
    EXPECT_GE(found[i].nearest, shortest * (1 - 1e-5));
    EXPECT_LE(found[i].nearest, longest * (1 + 1e-5));
  }
  EXPECT_GT(boards, 20);
  EXPECT_GT(flaps, 20);
}

TEST(HidingObjects, AreNoneWhereNothingCasts) {
  scenes::Scene scene = board_and_flap();
  for (scenes::Object& object : scene.objects) object.casts_shadow = false;
  const Stage setup(scene, 8, 8);
  std::vector<std::uint32_t> pixels(setup.samples.size());
  std::iota(pixels.begin(), pixels.end(), 0U);
  for (const HiddenBy& hidden : hiding_objects(setup.floats, setup.samples, setup.light, pixels))
    EXPECT_FALSE(hidden.own || hidden.other);
}

}  // namespace
}  // namespace penumbra::reference
