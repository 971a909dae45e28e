// SPDX-License-Identifier: Apache-2.0
// Compares sums over silhouettes with areas that use no silhouettes: of each triangle by itself, and of their exact
// union.

#include "mesh/shapes/shapes.hpp"
#include "tests/unit/coverage_stage.hpp"
#include "tests/unit/exact_area_soups.hpp"

#include <gtest/gtest.h>

namespace penumbra::volumes {
namespace {

using tests::CoverageStage;
using tests::Lamp;

/// Returns soups between the floor and the light, which no triangle touches.
scenes::Scene soup_below(std::mt19937& random, Lamp lamp, int count) {
  std::vector<tests::Corners> soup = tests::lattice_soup(random, count);
  for (tests::Corners& corners : soup) {
    for (glm::dvec3& corner : corners) corner.y = corner.y * 0.5 - 0.25;  // −1 … 1.5
  }
  return tests::soup_scene(soup, lamp);
}

TEST(CoverageAgreement, TheReceiversSilhouettesAddUpToItsLayers) {
  std::mt19937 random(7);
  int part = 0, moved = 0;
  for (int i = 0; i < 200; ++i) {
    const CoverageStage stage(soup_below(random, static_cast<Lamp>(i % 4), 2 + i % 9));
    for (int j = 0; j < 20; ++j) {
      const glm::vec3 p = tests::soup_receiver(random);
      const LayerSum sum = stage.receiver(p);
      const auto layers = stage.layers(p);
      const double expected = sum_of_layers(stage.soft.outline(), layers), exact = 1 - stage.exact(p);
      ASSERT_NEAR(sum.blocked, expected, 1e-9) << i << " " << j;
      // Without an overlap the sum equals the union; it never exceeds the union by more than the overlap. The union's
      // disk is a polygon, off by 7.6e-8 at most.
      const double overlap = overlap_of_layers(stage.soft.outline(), layers, 100);
      const double tolerance = stage.light.kind == visibility::LightKind::disk ? 1e-7 : 1e-9;
      ASSERT_GE(expected - exact, -tolerance);
      ASSERT_LE(expected - exact, overlap + tolerance);
      part += expected > 0 && expected < 1 ? 1 : 0;
      moved += sum.moved ? 1 : 0;
    }
  }
  EXPECT_GT(part, 1000);
  EXPECT_GT(moved, 3);
}

}  // namespace
}  // namespace penumbra::volumes
