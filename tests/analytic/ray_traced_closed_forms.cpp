// SPDX-License-Identifier: Apache-2.0
// Tests the ray caster against shadows in closed form: which light samples are hidden (exactly, except for pairs within
// rounding of the projected edge, which are counted), and how fast the share approaches the area.

#include "tests/analytic/board_over_floor.hpp"
#include "tests/unit/ray_traced_masks.hpp"
#include "tests/unit/visibility/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra::reference {
namespace {

using tests::Masks;
using tests::Stage;
using visibility::Light;
using visibility::SamplePattern;
using visibility::SceneFloats;
using visibility::ViewSamples;

/// Embree's edge tests are in float32 on coordinates up to `extent`: they may be off by eight of its ulps.
tests::BoardPairs compare(const Stage& stage, double extent) {
  return tests::compare_with_board(stage, tests::trace(stage), 8 * extent * 0x1p-23);
}

TEST(ClosedForm, ParallelSquareHidesExactlyItsProjection) {
  for (const glm::dvec2& size : {glm::dvec2(0.5, 0.5), glm::dvec2(0.25, 1.5), glm::dvec2(0.7, 0.3)}) {
    const Stage stage(tests::board_scene(-size, size), 96, 96, {256, 0, 0, SamplePattern::rows, 0});
    expect_board(compare(stage, 4), 10000, 1e-4);
  }
}

TEST(ClosedForm, HalfPlaneHidesExactlyItsProjection) {
  // The board reaches so far to the left, front and back that only its right edge appears on the light.
  const Stage stage(tests::board_scene({-64, -64}, {0.25, 64}), 96, 96, {256, 0, 0, SamplePattern::sobol, 0});
  expect_board(compare(stage, 64), 100000, 1e-3);
}

TEST(ClosedForm, TheShareConvergesToTheProjectedArea) {
  tests::expect_board_share_converges([](const Stage& stage) { return tests::trace(stage); });
}

/// A single view sample at `target`, seen from `eye`.
ViewSamples one_sample(const SceneFloats& floats, const glm::dvec3& eye, const glm::dvec3& target) {
  const auto pinhole = visibility::make_camera(tests::camera(eye, target), floats.origin, 1, 1);
  return visibility::brute_force_view_samples(floats, pinhole);
}

std::vector<tests::Corners> sphere(const glm::dvec3& center, double radius, int segments) {
  const auto at = [&](int i, int j) {
    const double polar = std::numbers::pi * i / segments, around = 2 * std::numbers::pi * (j % segments) / segments;
    return center +
           radius * glm::dvec3(std::sin(polar) * std::cos(around), std::cos(polar), std::sin(polar) * std::sin(around));
  };
  std::vector<tests::Corners> triangles;
  for (int i = 0; i < segments; ++i) {
    for (int j = 0; j < segments; ++j) {
      triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      triangles.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return triangles;
}

TEST(ClosedForm, ASphereHidesTheDiskOfItsTangentCone) {
  // A ball of radius r at distance d from p fills a cone with sin(angle) = r / d: on a disk light of radius R at
  // distance D on the same axis it hides (D tan(angle) / R)² of the area.
  for (const double radius : {0.1, 0.2, 0.35}) {
    scenes::Scene scene;
    tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
    tests::add_object(scene, "ball", sphere({0, 2, 0}, radius, 96));
    scene.lights.emplace_back();
    scene.lights[0].shape = scenes::Disk{{0, 4, 0}, {0, -1, 0}, 1};
    const SceneFloats floats = visibility::make_scene_floats(scene);
    const Light light = visibility::make_light(scene, 0, floats.origin, {4096, 0, 0, SamplePattern::sobol, 2});
    const Masks masks = tests::trace(floats, light, one_sample(floats, {3, 0.5, 0}, {0, 0, 0}));
    const double tangent = std::tan(std::asin(radius / 2));
    EXPECT_NEAR(masks.visibility[0], 1 - std::pow(4 * tangent, 2), 0.006) << radius;
  }
}

TEST(ClosedForm, HalfOfASphereLightBehindAWall) {
  // The wall's edge lies in the plane through p and the light's centre: it hides half of the disk that p sees.
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  tests::add_object(scene, "wall", tests::quad({2, 1, 0}, {2, 0, 0}, {0, 0, -3}));
  scene.lights.emplace_back();
  scene.lights[0].shape = scenes::Sphere{{0, 3, 0}, 0.5};
  const SceneFloats floats = visibility::make_scene_floats(scene);
  const Light light = visibility::make_light(scene, 0, floats.origin, {4096, 0, 0, SamplePattern::sobol, 2});
  const Masks masks = tests::trace(floats, light, one_sample(floats, {-3, 0.5, 0}, {0, 0, 0}));
  EXPECT_NEAR(masks.visibility[0], 0.5, 0.005);
}

TEST(ClosedForm, ASphereLightBehindAHalfPlaneLosesASegmentOfItsDisk) {
  // The tangents from p at distance d touch the sphere at a disk of radius ρ = r √(1 − r²/d²), at height (d² − r²) / d.
  // A board's edge at half of that height and x = c appears at 2 c on the disk.
  const double r = 0.75, d = 3, height = (d * d - r * r) / d, rho = r * std::sqrt(1 - r * r / (d * d));
  for (const double share : {-0.75, -0.25, 0.0, 0.5}) {
    scenes::Scene scene;
    tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
    tests::add_object(scene, "board", tests::quad({2 + share * rho / 2, height / 2, 0}, {2, 0, 0}, {0, 0, -3}));
    scene.lights.emplace_back();
    scene.lights[0].shape = scenes::Sphere{{0, d, 0}, r};
    const SceneFloats floats = visibility::make_scene_floats(scene);
    const Light light = visibility::make_light(scene, 0, floats.origin, {4096, 0, 0, SamplePattern::sobol, 2});
    const Masks masks = tests::trace(floats, light, one_sample(floats, {-3, 0.5, 0}, {0, 0, 0}));
    const double hidden = (std::acos(share) - share * std::sqrt(1 - share * share)) / std::numbers::pi;
    EXPECT_NEAR(masks.visibility[0], 1 - hidden, 0.004) << share;
  }
}

TEST(ClosedForm, ASphereLightBehindABallLosesTheBallsCone) {
  // Ball and light are on one axis: the hidden share follows from the ball's cone over the light's cone, in the plane
  // of the light's disk.
  const double r = 0.75, d = 4, tangent = r / std::sqrt(d * d - r * r);
  for (const double radius : {0.1, 0.2, 0.3}) {
    scenes::Scene scene;
    tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
    tests::add_object(scene, "ball", sphere({0, 2, 0}, radius, 96));
    scene.lights.emplace_back();
    scene.lights[0].shape = scenes::Sphere{{0, d, 0}, r};
    const SceneFloats floats = visibility::make_scene_floats(scene);
    const Light light = visibility::make_light(scene, 0, floats.origin, {4096, 0, 0, SamplePattern::sobol, 2});
    const Masks masks = tests::trace(floats, light, one_sample(floats, {3, 0.5, 0}, {0, 0, 0}));
    EXPECT_NEAR(masks.visibility[0], 1 - std::pow(std::tan(std::asin(radius / 2)) / tangent, 2), 0.006) << radius;
  }
}

TEST(ClosedForm, InsideASphereLightNothingIsVisible) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  scene.lights.emplace_back();
  scene.lights[0].shape = scenes::Sphere{{0, 0.5, 0}, 1};
  const SceneFloats floats = visibility::make_scene_floats(scene);
  const Light light = visibility::make_light(scene, 0, floats.origin, {64, 0, 0, SamplePattern::grid, 0});
  EXPECT_EQ(tests::trace(floats, light, one_sample(floats, {-3, 0.5, 0}, {0, 0, 0})).visibility[0], 0);
  EXPECT_GT(tests::trace(floats, light, one_sample(floats, {-3, 0.5, 0}, {2, 0, 0})).visibility[0], 0.4);
}

TEST(ClosedForm, ASunsPenumbraIsAsWideAsDistanceTimesTangent) {
  // A sun straight above, and a board at height h whose edge is at x = 0: from x the board appears from (−x / h) on,
  // and the sun's disk has the radius tan(angle / 2). The sun is straight above because a tilted sun would move the
  // shadow, and the plane of its frame would not be the board's.
  constexpr double kHeight = 2;
  for (const double angle : {0.53, 10.0, 60.0}) {
    const double tangent = std::tan(angle * std::numbers::pi / 360);
    scenes::Scene scene;
    tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {8, 0, 0}, {0, 0, -8}));
    tests::add_object(scene, "board", tests::quad({4, kHeight, 0}, {4, 0, 0}, {0, 0, -8}));
    scene.lights.emplace_back();
    scene.lights[0].shape = scenes::Sun{{0, -1, 0}, angle};
    const SceneFloats floats = visibility::make_scene_floats(scene);
    const Light light = visibility::make_light(scene, 0, floats.origin, {4096, 0, 0, SamplePattern::sobol, 2});
    for (const double share : {-1.01, -0.99, -0.5, 0.0, 0.25, 0.99, 1.01}) {
      const glm::dvec3 at(-share * kHeight * tangent, 0, 0);
      const Masks masks = tests::trace(floats, light, one_sample(floats, {-3, 0.5, 0}, at));
      const double s = std::clamp(share, -1.0, 1.0);
      const double hidden = (std::acos(s) - s * std::sqrt(1 - s * s)) / std::numbers::pi;
      // At ±0.99 a few samples of 4096 are left: the hidden share is neither 0 nor 1.
      EXPECT_NEAR(masks.visibility[0], 1 - hidden, 0.003) << angle << " at " << share;
      if (std::abs(share) > 1) {
        EXPECT_EQ(masks.visibility[0], share > 0 ? 1 : 0) << angle << " at " << share;
      } else {
        EXPECT_TRUE(masks.visibility[0] > 0 && masks.visibility[0] < 1) << angle << " at " << share;
      }
    }
  }
}

TEST(ClosedForm, ASunOfAngleZeroCastsHardShadows) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {8, 0, 0}, {0, 0, -8}));
  tests::add_object(scene, "board", tests::quad({0, 2, 0}, {1, 0, 0}, {0, 0, -1}));
  scene.lights.emplace_back();
  scene.lights[0].shape = scenes::Sun{{-1, -1, 0}, 0};  // moves the board's shadow by −2
  const SceneFloats floats = visibility::make_scene_floats(scene);
  const Light light = visibility::make_light(scene, 0, floats.origin, {16, 4, 4, SamplePattern::grid, 0});
  for (const double x : {-3.01, -2.99, -2.0, -1.01, -0.99}) {
    const Masks masks = tests::trace(floats, light, one_sample(floats, {-6, 0.5, 0}, {x, 0, 0.25}));
    EXPECT_EQ(masks.visibility[0], x > -3 && x < -1 ? 0 : 1) << x;
  }
}

TEST(ClosedForm, TheHorizonCutsASun) {
  // The sun's centre is on the horizon: the floor sees its upper half.
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  scene.lights.emplace_back();
  scene.lights[0].shape = scenes::Sun{{1, 0, 0}, 20};
  const SceneFloats floats = visibility::make_scene_floats(scene);
  const Light light = visibility::make_light(scene, 0, floats.origin, {4096, 0, 0, SamplePattern::sobol, 2});
  EXPECT_NEAR(tests::trace(floats, light, one_sample(floats, {-3, 0.5, 0}, {0, 0, 0})).visibility[0], 0.5, 0.001);
}

}  // namespace
}  // namespace penumbra::reference
