// SPDX-License-Identifier: Apache-2.0
// The coverage integral against areas in closed form.
//
// Tolerance: an area is a sum of a handful of terms below 4, each off by a few ulps of 1, whose ends are off by a few
// ulps of their size: 1e-12 is thousands of ulps and far below what a wrong edge would cost.

#include "mesh/shapes/shapes.hpp"
#include "tests/unit/coverage_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra::volumes {
namespace {

using tests::area_scene;
using tests::CoverageStage;
using tests::random_dyadic;

constexpr double kRounding = 1e-12;

TEST(CoverageClosedForm, AParallelRectangleHidesTheOverlapOfItsProjection) {
  std::mt19937 random(1);
  int part = 0;
  for (int scene_number = 0; scene_number < 20; ++scene_number) {
    const glm::dvec3 center(random_dyadic(random, -1, 1), random_dyadic(random, 0.25, 3.75),
                            random_dyadic(random, -1, 1));
    const glm::dvec2 half(random_dyadic(random, 0.125, 1), random_dyadic(random, 0.125, 1));
    scenes::Scene scene = area_scene(tests::quad(center, {half.x, 0, 0}, {0, 0, half.y}));
    scene.lights.push_back(tests::ceiling_light(4, 1));
    const CoverageStage stage(scene);
    for (int i = 0; i < 50; ++i) {
      const glm::vec3 p(random_dyadic(random, -3, 3), 0, random_dyadic(random, -3, 3));
      const auto overlap = [&](double at, double from, double reach) {
        const double scale = 4 / center.y, low = at + scale * (from - reach - at),
                     high = at + scale * (from + reach - at);
        return std::max(0.0, std::min(high, 1.0) - std::max(low, -1.0));
      };
      const double expected = overlap(p.x, center.x, half.x) * overlap(p.z, center.z, half.y) / 4;
      const LayerSum by_center = stage.center(p), by_receiver = stage.receiver(p);
      ASSERT_NEAR(by_center.blocked, expected, kRounding);
      ASSERT_NEAR(by_receiver.blocked, expected, kRounding);
      ASSERT_NEAR(sum_of_layers(stage.soft.outline(), stage.layers(p)), expected, kRounding);
      part += expected > 0 && expected < 1 ? 1 : 0;
    }
  }
  EXPECT_GT(part, 100);
}

/// A board over x ≥ c at half height hides x ≥ 2 c of the light as seen from the origin.
scenes::Scene half_plane(double c) {
  return area_scene(tests::quad({8 + c, 2, 0}, {8, 0, 0}, {0, 0, 16}));
}

TEST(CoverageClosedForm, AHalfPlaneHidesItsShareOfASquareAndItsSegmentOfADisk) {
  for (const double c : {-0.484375, -0.25, 0.0, 0.125, 0.375}) {
    scenes::Scene scene = half_plane(c);
    scene.lights.push_back(tests::ceiling_light(4, 1));
    EXPECT_NEAR(CoverageStage(scene).center({0, 0, 0}).visibility, (1 + 2 * c) / 2, kRounding) << c;
    scene.lights[0].shape = scenes::Disk{{0, 4, 0}, {0, -1, 0}, 1};
    const double hidden = (std::acos(2 * c) - 2 * c * std::sqrt(1 - 4 * c * c)) / std::numbers::pi;
    const CoverageStage stage(scene);
    EXPECT_NEAR(stage.center({0, 0, 0}).visibility, 1 - hidden, kRounding) << c;
    EXPECT_NEAR(stage.receiver({0, 0, 0}).visibility, 1 - hidden, kRounding) << c;
    EXPECT_NEAR(sum_of_layers(stage.soft.outline(), stage.layers({0, 0, 0})), hidden, kRounding) << c;
  }
}

TEST(CoverageClosedForm, PolygonLights) {
  scenes::Scene scene = half_plane(0.25);
  scene.lights.emplace_back().shape = scenes::Polygon{{{0, 4, 0}, {1, 4, 0}, {0, 4, 1}}};
  EXPECT_NEAR(CoverageStage(scene).center({0, 0, 0}).visibility, 0.75, kRounding);
  scene.lights[0].shape = scenes::Polygon{{{-1, 4, -1}, {1, 4, -1}, {2, 4, 0}, {1, 4, 1}, {-1, 4, 1}}};
  EXPECT_NEAR(CoverageStage(scene).center({0, 0, 0}).visibility, 3.0 / 5, kRounding);
}

TEST(CoverageClosedForm, ATwoSidedLightLooksTheSameFromBehind) {
  for (const double side : {1.0, -1.0}) {
    scenes::Scene scene = area_scene(tests::quad({0.125, 2, 0.0625}, {0.375, 0, 0}, {0, 0, 0.1875}));
    scene.lights.push_back(tests::rectangle_light({0, 4, 0}, {1, 0, 0}, {0, 0, side}));
    EXPECT_EQ(CoverageStage(scene).center({0, 0, 0}).in_front, side > 0);
    scene.lights[0].two_sided = true;
    for (const LayerSum& sum : {CoverageStage(scene).center({0, 0, 0}), CoverageStage(scene).receiver({0, 0, 0})}) {
      EXPECT_NEAR(sum.visibility, 1 - 1.5 * 0.75 / 4, kRounding);
    }
  }
}

TEST(CoverageClosedForm, AnEdgeThroughTheCentreIsDecidedAsTheCountIs) {
  // From x the board's edge x = 0, at half height, appears at −x on the light: through the centre, or an ulp beside it.
  for (const float x : {0.0F, 0x1p-40F, -0x1p-40F, 0x1p-20F, -0x1p-20F}) {
    scenes::Scene scene = half_plane(0);
    scene.lights.push_back(tests::ceiling_light(4, 1));
    for (const bool disk : {false, true}) {
      if (disk) scene.lights[0].shape = scenes::Disk{{0, 4, 0}, {0, -1, 0}, 1};
      const CoverageStage stage(scene);
      for (const LayerSum& sum : {stage.center({x, 0, 0}), stage.receiver({x, 0, 0})}) {
        EXPECT_FALSE(sum.moved);
        const double slope = disk ? 2 / std::numbers::pi : 0.5;  // the chord through the centre over the area
        EXPECT_NEAR(sum.visibility, 0.5 - slope * static_cast<double>(x), kRounding) << x << " " << disk;
      }
    }
  }
}

TEST(CoverageClosedForm, AVertexAtTheCentreMovesTheReferencePoint) {
  // One quadrant with its corner at the centre, and a bow tie of two quadrants that touch there.
  for (const bool tie : {false, true}) {
    for (const bool disk : {false, true}) {
      std::vector<tests::Corners> boards = tests::quad({4, 2, 4}, {4, 0, 0}, {0, 0, 4});
      if (tie) {
        for (const tests::Corners& corners : tests::quad({-4, 2, -4}, {4, 0, 0}, {0, 0, 4})) boards.push_back(corners);
      }
      scenes::Scene scene = area_scene(boards);
      scene.lights.push_back(tests::ceiling_light(4, 1));
      if (disk) scene.lights[0].shape = scenes::Disk{{0, 4, 0}, {0, -1, 0}, 1};
      const CoverageStage stage(scene);
      for (const LayerSum& sum : {stage.center({0, 0, 0}), stage.receiver({0, 0, 0})}) {
        EXPECT_TRUE(sum.moved);
        EXPECT_NEAR(sum.visibility, tie ? 0.5 : 0.75, kRounding);
      }
    }
  }
}

TEST(CoverageClosedForm, ASolidIsOneLayerFromOutsideAndFromWithin) {
  // A box over the origin with its top at 2 and its bottom at 1. From below, the bottom looks twice as large as the
  // light and hides all of it, as one layer. A light within a closed room is hidden by no wall.
  scenes::Scene scene = area_scene(tests::corners_of(mesh::make_box({0, 1.5, 0}, {2, 0.5, 2})));
  scene.lights.push_back(tests::ceiling_light(4, 1));
  const LayerSum below = CoverageStage(scene).center({0, 0, 0});
  EXPECT_EQ(below.constant, 1);
  EXPECT_EQ(below.visibility, 0);
  scenes::Scene room = area_scene(tests::corners_of(mesh::make_box({0, 3, 0}, {8, 4, 8})));
  room.lights.push_back(tests::ceiling_light(4, 1));
  EXPECT_EQ(CoverageStage(room).center({0, 0, 0}).visibility, 1);
  EXPECT_EQ(CoverageStage(room).receiver({0, 0, 0}).visibility, 1);
  // From outside the room the light is behind one wall.
  EXPECT_EQ(CoverageStage(room).center({20, 0, 0}).constant, 1);
  EXPECT_EQ(CoverageStage(room).center({20, 0, 0}).visibility, 0);
}

TEST(CoverageClosedForm, HorizonSamplesGetNoMoreThanWhatIsAbove) {
  for (const double h : {-2.0, -0.75, -0.25, 0.0, 0.5, 2.0}) {
    scenes::Scene scene = area_scene({});
    scene.lights.push_back(tests::rectangle_light({4, h, 0}, {0, 0, 1}, {0, 1, 0}));
    EXPECT_NEAR(CoverageStage(scene).center({0, 0, 0}).visibility, std::clamp((1 + h) / 2, 0.0, 1.0), kRounding);
    scene.lights[0].shape = scenes::Disk{{4, h, 0}, {-1, 0, 0}, 1};
    const double d = std::clamp(h, -1.0, 1.0);
    EXPECT_NEAR(CoverageStage(scene).center({0, 0, 0}).visibility,
                (std::acos(-d) + d * std::sqrt(1 - d * d)) / std::numbers::pi, 1e-7);  // stored in float32
  }
}

}  // namespace
}  // namespace penumbra::volumes
