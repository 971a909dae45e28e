// SPDX-License-Identifier: Apache-2.0
// Tests the method `exact`: values for wanted pixels only, refused options, and the same bits however a picture is
// divided into tiles.

#include "reference/methods.hpp"

#include "base/error.hpp"
#include "tests/unit/ray_traced_masks.hpp"
#include "tests/unit/visibility/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace penumbra::reference {
namespace {

using tests::Stage;

scenes::Scene board_over_floor() {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  tests::add_object(scene, "board", tests::quad({0.1, 1, 0}, {1, 0.2, 0}, {0, 0.1, -1}));
  scene.lights.push_back(tests::ceiling_light(4, 1));
  scene.cameras.push_back(tests::camera({0.3, 2.7, 6}, {0, 0.3, 0}));
  return scene;
}

std::vector<float> evaluate(const Stage& stage, visibility::Method& method, std::uint32_t rows) {
  method.prepare_mesh(stage.floats);
  method.prepare_light(stage.light);
  method.prepare_view(stage.samples);
  std::vector<float> result(stage.samples.size());
  for (std::uint32_t first = 0; first < stage.samples.height; first += rows) {
    const visibility::Tile tile{first, std::min(rows, stage.samples.height - first)};
    method.evaluate(tile);
    method.read_visibility(std::span(result).subspan(std::size_t{first} * stage.samples.width,
                                                     std::size_t{tile.row_count} * stage.samples.width));
  }
  return result;
}

TEST(ExactMethod, OnlyWantedPixelsAreEvaluatedAndTheyAreTheSame) {
  const Stage stage(board_over_floor(), 32, 24);
  const auto all_of_them = make_exact({});
  const std::vector<float> all = evaluate(stage, *all_of_them, 8);
  const std::vector<std::uint32_t> wanted = {0, 40, 333, 334, 500, 767};
  const auto some_of_them = make_exact({});
  some_of_them->want_pixels(wanted);
  const std::vector<float> some = evaluate(stage, *some_of_them, 5);
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    EXPECT_FALSE(std::isnan(all[i]));
    if (std::ranges::find(wanted, i) != wanted.end()) {
      EXPECT_EQ(some[i], all[i]) << i;
    } else {
      EXPECT_TRUE(std::isnan(some[i])) << i;
    }
  }
  EXPECT_LE(some_of_them->counters().at("viewSamples"), wanted.size());
}

TEST(ExactMethod, TheRayCasterComesNearIt) {
  // Rows of 64 × 64 light samples, one convex occluder. In each row the hidden part is an interval, and the number of
  // samples in it is wrong by less than one of 64. From row to row its length rises once and falls once, by at most 1
  // each: the midpoint rule is wrong by at most half a row times that variation, 1/2 · 1/64 · 2. (Moving a row's
  // samples along the row changes neither.)
  const Stage stage(board_over_floor(), 32, 24, {4096, 0, 0, visibility::SamplePattern::rows, 0});
  const auto method = make_exact({});
  const std::vector<float> exact = evaluate(stage, *method, 8);
  const tests::Masks masks = tests::trace(stage);
  int part = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    EXPECT_NEAR(exact[i], masks.visibility[i], 2.0 / 64) << i;
    part += exact[i] > 0 && exact[i] < 1 ? 1 : 0;
  }
  EXPECT_GT(part, 50);
}

TEST(ExactMethod, RefusesOptionsThatItDoesNotHave) {
  EXPECT_THROW(make_exact({{"sweep", "fast"}}), UsageError);
  EXPECT_THROW(make_exact({{"kernel", "exact"}}), UsageError);
  const Stage stage(board_over_floor(), 8, 8);
  const auto rounded = make_exact({}), rational = make_exact({{"sweep", "rational"}});
  EXPECT_EQ(evaluate(stage, *rounded, 8),
            evaluate(stage, *rational, 8));  // float32 of numbers that differ by at most 1e-12
}

}  // namespace
}  // namespace penumbra::reference
