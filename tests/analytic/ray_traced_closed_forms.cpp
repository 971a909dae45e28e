// The ray caster against shadows that can be written down: which light samples are hidden (exactly, except for pairs
// within rounding of the projected edge, which are counted), and how fast the share approaches the area.

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

constexpr double kLightHeight = 4, kLightHalf = 1, kBoardHeight = 1;

/// A floor at height 0, a board at 1 and a square light of half-size 1 at 4, all parallel. With the board's corners
/// given, everything else is exact in float32.
scenes::Scene board_scene(const glm::dvec2& lower, const glm::dvec2& upper) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  const glm::dvec2 middle = 0.5 * (lower + upper), half = 0.5 * (upper - lower);
  tests::add_object(scene, "board", tests::quad({middle.x, kBoardHeight, middle.y}, {half.x, 0, 0}, {0, 0, -half.y}));
  scene.lights.push_back(tests::ceiling_light(kLightHeight, kLightHalf));
  scene.cameras.push_back(tests::camera({0.2, 0.9, 5.1}, {0.1, 0, 0.3}, 60));
  return scene;
}

/// How far inside the board (positive) or outside (negative) the segment p→l crosses its height, in world units.
double depth_inside(const glm::dvec3& p, const glm::dvec3& l, const glm::dvec2& lower, const glm::dvec2& upper) {
  const glm::dvec3 q = p + (kBoardHeight - p.y) / (l.y - p.y) * (l - p);
  return std::min(std::min(q.x - lower.x, upper.x - q.x), std::min(q.z - lower.y, upper.y - q.z));
}

struct Comparison {
  std::size_t pairs = 0, wrong = 0, within_rounding = 0;
};

/// p and l are the stored floats, their crossing point is theirs up to double rounding; Embree's edge tests are float32
/// on coordinates up to `extent`: eight of its ulps is what they may be off.
Comparison compare_pairs(const Stage& setup, const glm::dvec2& lower, const glm::dvec2& upper, double extent) {
  const Masks masks = tests::trace(setup);
  const double rounding = 8 * extent * 0x1p-23;
  Comparison result;
  for (std::size_t pixel = 0; pixel < setup.samples.size(); ++pixel) {
    const std::int32_t triangle = setup.samples.triangle[pixel];
    if (triangle == ViewSamples::kBackground || triangle >= 2) continue;  // floor only
    const glm::dvec3 p = glm::dvec3(setup.samples.p[pixel]) + setup.floats.origin;
    for (std::size_t j = 0; j < setup.light.points.size(); ++j) {
      const glm::dvec3 l = glm::dvec3(setup.light.points[j]) + setup.floats.origin;
      const double inside = depth_inside(p, l, lower, upper);
      ++result.pairs;
      if (std::abs(inside) < rounding) {
        ++result.within_rounding;
      } else if (masks.visible(pixel, j) != (inside < 0)) {
        ++result.wrong;
      }
    }
  }
  return result;
}

TEST(ClosedForm, ParallelSquareHidesExactlyItsProjection) {
  for (const glm::dvec2& size : {glm::dvec2(0.5, 0.5), glm::dvec2(0.25, 1.5), glm::dvec2(0.7, 0.3)}) {
    const Stage setup(board_scene(-size, size), 96, 96, {256, 0, 0, SamplePattern::rows, 0});
    const Comparison result = compare_pairs(setup, -size, size, 4);
    EXPECT_GT(result.pairs, 500000u);
    EXPECT_EQ(result.wrong, 0u) << "of " << result.pairs << ", " << result.within_rounding << " within rounding";
    EXPECT_LE(result.within_rounding, result.pairs / 10000);
  }
}

TEST(ClosedForm, HalfPlaneHidesExactlyItsProjection) {
  // Far enough to the left, front and back that only its right edge is on the light.
  const glm::dvec2 lower(-64, -64), upper(0.25, 64);
  const Stage setup(board_scene(lower, upper), 96, 96, {256, 0, 0, SamplePattern::sobol, 0});
  const Comparison result = compare_pairs(setup, lower, upper, 64);
  EXPECT_GT(result.pairs, 500000u);
  EXPECT_EQ(result.wrong, 0u) << "of " << result.pairs << ", " << result.within_rounding << " within rounding";
  EXPECT_LE(result.within_rounding, result.pairs / 1000);
}

/// The share of the light [−1, 1]² that the board hides from p: the board's corners, seen from p = (x, 0, z), fall on
/// the light's plane at p + (corner − p) · light height / board height, and stay an axis-aligned rectangle.
double hidden_share(const glm::dvec3& p, const glm::dvec2& lower, const glm::dvec2& upper) {
  const double scale = kLightHeight / kBoardHeight;
  const auto overlap = [&](double from, double to, double at) {
    const double low = std::max(at + scale * (from - at), -kLightHalf),
                 high = std::min(at + scale * (to - at), kLightHalf);
    return std::max(0.0, high - low) / (2 * kLightHalf);
  };
  return overlap(lower.x, upper.x, p.x) * overlap(lower.y, upper.y, p.z);
}

TEST(ClosedForm, TheShareConvergesToTheProjectedArea) {
  const glm::dvec2 size(0.19, 0.3);
  double previous = 1;
  for (const std::uint32_t side : {4u, 8u, 16u, 32u, 64u}) {
    const Stage setup(board_scene(-size, size), 64, 64, {side * side, 0, 0, SamplePattern::rows, 0});
    const Masks masks = tests::trace(setup);
    double squares = 0, worst = 0;
    int count = 0;
    for (std::size_t pixel = 0; pixel < setup.samples.size(); ++pixel) {
      const std::int32_t triangle = setup.samples.triangle[pixel];
      if (triangle == ViewSamples::kBackground || triangle >= 2) continue;
      const glm::dvec3 p = glm::dvec3(setup.samples.p[pixel]) + setup.floats.origin;
      const double hidden = hidden_share(p, -size, size), error = masks.visibility[pixel] - (1 - hidden);
      if (hidden == 0) continue;
      squares += error * error;
      worst = std::max(worst, std::abs(error));
      ++count;
    }
    // A sample stands for its row's height and its cell's width. Across the rows the count is off by less than one row
    // of 1 / side (half a row at each of two edges), along each row by less than one cell of 1 / side².
    EXPECT_LE(worst, 2.0 / side) << side;
    const double rmse = std::sqrt(squares / count);
    RecordProperty("rmse" + std::to_string(side * side), std::to_string(rmse));
    EXPECT_LT(rmse, 0.8 * previous) << side;
    previous = rmse;
  }
  EXPECT_LT(previous, 0.003);
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
  // From p a ball of radius r at distance d fills a cone with sin(angle) = r / d: on a disk light of radius R at
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
  // The wall's edge is in the plane through p and the light's centre: it hides half of the disk that p sees.
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
  // From p at distance d the tangents meet the disk, of radius ρ = r √(1 − r²/d²), at the height (d² − r²) / d. A
  // board's edge at half of that height and x = c appears at 2 c on it.
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
  // Ball and light on one axis: the ball's cone over the light's, in the plane of the light's disk.
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
  // Straight above, a board's edge at the height h over x = 0 and beyond: from x the board appears from (−x / h) on,
  // and the sun's disk has the radius tan(angle / 2). A tilted sun moves the shadow, and its frame's plane is not the
  // board's.
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
      // At ±0.99 a few samples in 4096 are left: hidden is not 0 or 1.
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
  // At the elevation 0 the floor sees the upper half of the disk.
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
