// SPDX-License-Identifier: Apache-2.0
// Domes of one radiance against closed-form factors (J. Howell, A catalog of radiation heat transfer configuration
// factors): V is one minus the form factor of what hides the sky. Areas must agree up to rounding, masks up to the
// resolution of their light samples.

#include "tests/unit/dome_stage.hpp"
#include "visibility/dome_faces.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace penumbra::tests {
namespace {

using std::numbers::pi;

/// The form factor of a rectangle that stands on the element's plane at distance `c`: from its foot it extends `a` to
/// one side and `b` up.
double standing(double a, double b, double c) {
  const double far = std::hypot(b, c);
  return (std::atan(a / c) - c / far * std::atan(a / far)) / (2 * pi);
}

/// The form factor of a rectangle parallel to the element at height `c`: from the point above the element it extends
/// `a` and `b` to the sides. Odd in both.
double parallel(double a, double b, double c) {
  const double s = a / c, t = b / c, u = std::hypot(1.0, s), v = std::hypot(1.0, t);
  return (s / u * std::atan(t / u) + t / v * std::atan(s / v)) / (2 * pi);
}

/// A floor at y = 0, seen from above, under a dome.
scenes::Scene floor_scene(const scenes::Dome& dome, double half = 4) {
  scenes::Scene scene;
  add_object(scene, "floor", quad({0, 0, 0}, {half, 0, 0}, {0, 0, -half}));
  scene.cameras.push_back(camera({0.3, 6, 4}, {0.1, 0, 0.2}, 20));
  scene.lights.push_back(dome_light(dome));
  return scene;
}

std::vector<scenes::Dome> kinds_of_dome() {
  return {scenes::Dome{}, scenes::Dome{.half = true}, scenes::Dome{.up = glm::normalize(glm::dvec3(0.3, 1, -0.2))},
          scenes::Dome{.rotate = 30, .half = true}};
}

struct Tolerance {
  double areas = 2e-7, masks = 0.02;
  double whole = 1;  ///< the form factor of all of the dome
};

/// Checks V of every method at floor pixels; `expected` gives V at a point, under one radiance all around or in the
/// upper half.
void expect_shares(const scenes::Scene& scene, const std::function<double(const glm::dvec3&)>& expected,
                   const Tolerance& tolerance = {}) {
  const Stage stage(scene, 24, 24, {1024, 0, 0, visibility::SamplePattern::sobol, 0});
  const auto check = [&](const std::string& name, const DomeAnswer& answer, double off) {
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (stage.samples.triangle[i] < 0 ||
          stage.floats.object[static_cast<std::size_t>(stage.samples.triangle[i])] != 0)
        continue;
      ++pixels;
      const glm::dvec3 p = glm::dvec3(stage.samples.p[i]) + stage.floats.origin;
      ASSERT_NEAR(answer.masks.visibility[i], expected(p), off) << name << " at " << p.x << ", " << p.z;
      if (!answer.form_factors.empty()) {
        ASSERT_NEAR(answer.form_factors[i].x, tolerance.whole * expected(p), off) << name;
      }
    }
    EXPECT_GT(pixels, 100U) << name;
  };
  for (const auto& [name, method] : dome_area_methods()) check(name, answer_of(*method, stage), tolerance.areas);
  for (const auto& [name, method] : dome_mask_methods()) check(name, answer_of(*method, stage), tolerance.masks);
  check("raytrace", {trace(stage), {}}, tolerance.masks);
}

TEST(DomeClosedForm, APlaneSeesAllOfHalfASphere) {
  for (const scenes::Dome& dome : {scenes::Dome{}, scenes::Dome{.half = true}})
    expect_shares(floor_scene(dome), [](const glm::dvec3&) { return 1.0; }, {0, 0});
}

/// Half a dome that leans by φ has (1 + cos φ) / 2 of a whole dome's form factor; V of a plane is still 1.
TEST(DomeClosedForm, HalfADomeThatLeansIsSeenByItsCosine) {
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.5, 1, 0.25));
  const Stage stage(floor_scene({.up = up, .half = true}), 8, 8, {64, 0, 0, visibility::SamplePattern::rows, 0});
  for (const auto& [name, method] : dome_area_methods()) {
    const DomeAnswer answer = answer_of(*method, stage);
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      EXPECT_EQ(answer.masks.visibility[i], 1) << name;
      EXPECT_NEAR(answer.form_factors[i].x, (1 + up.y) / 2, 1e-6) << name;
    }
  }
}

TEST(DomeClosedForm, AWallHidesItsFormFactor) {
  constexpr double kHeight = 1.5, kLong = 3, kAt = 1.25;
  for (const scenes::Dome& dome : {scenes::Dome{}, scenes::Dome{.half = true}, scenes::Dome{.rotate = 30}}) {
    scenes::Scene scene = floor_scene(dome);
    add_object(scene, "wall", quad({kAt, kHeight / 2, 0}, {0, kHeight / 2, 0}, {0, 0, kLong}));
    expect_shares(scene, [&](const glm::dvec3& p) {
      const double far = std::abs(kAt - p.x);
      return 1 - standing(kLong - p.z, kHeight, far) - standing(kLong + p.z, kHeight, far);
    });
  }
}

/// V tends to (1 + cos φ) / 2 as the wall becomes long; φ is the angle up to its edge.
TEST(DomeClosedForm, ALongWallLeavesTheCosineOfItsEdge) {
  constexpr double kHeight = 1, kLong = 4096, kAt = 1.5;
  scenes::Scene scene = floor_scene({});
  add_object(scene, "wall", quad({kAt, kHeight / 2, 0}, {0, kHeight / 2, 0}, {0, 0, kLong}));
  expect_shares(scene,
                [&](const glm::dvec3& p) {
                  const double far = std::abs(kAt - p.x);
                  return (1 + far / std::hypot(far, kHeight)) / 2;
                },
                {1e-5, 0.02});
}

TEST(DomeClosedForm, ABoxLetsInWhatItsHoleShows) {
  constexpr double kHalf = 2, kHeight = 1.5, kHole = 0.5;
  for (const scenes::Dome& dome : kinds_of_dome()) {
    scenes::Scene scene = floor_scene(dome, kHalf);
    scene.cameras.front() = camera({0.1, 1.2, 0.2}, {0.3, 0, 0.1}, 60);
    for (const double side : {-1.0, 1.0}) {
      add_object(scene, "x", quad({side * kHalf, kHeight / 2, 0}, {0, kHeight / 2, 0}, {0, 0, kHalf}));
      add_object(scene, "z", quad({0, kHeight / 2, side * kHalf}, {0, kHeight / 2, 0}, {kHalf, 0, 0}));
      const double middle = side * (kHalf + kHole) / 2, half = (kHalf - kHole) / 2;
      add_object(scene, "left and right", quad({middle, kHeight, 0}, {half, 0, 0}, {0, 0, kHalf}));
      add_object(scene, "before and behind", quad({0, kHeight, middle}, {kHole, 0, 0}, {0, 0, half}));
    }
    expect_shares(scene, [&](const glm::dvec3& p) {
      double sum = 0;
      for (const double x : {-1.0, 1.0}) {
        for (const double z : {-1.0, 1.0}) sum += parallel(kHole - x * p.x, kHole - z * p.z, kHeight);
      }
      return sum;
    });
  }
}

/// A sphere above the plane hides (R / D)² cos θ; its faces hide a share of 1 − O(1 / rings²) of that.
TEST(DomeClosedForm, ASphereHidesItsSolidAngleTimesTheCosine) {
  constexpr double kRadius = 0.5;
  const glm::dvec3 center(0.2, 1, 0.1);
  scenes::Scene scene = floor_scene({});
  scene.cameras.front() = camera({0.3, 0.2, 4}, {0.1, 0, 0.2}, 20);
  add_object(scene, "ball", sphere(center, kRadius, 32));
  expect_shares(scene,
                [&](const glm::dvec3& p) {
                  const double far = glm::distance(p, center);
                  return 1 - kRadius * kRadius / (far * far) * (center.y / far);
                },
                {2e-3, 0.02});
}

/// Half a dome around +X lights a floor from one side: a long wall on that side hides everything below its edge.
TEST(DomeClosedForm, HalfADomeFromASideIsHiddenByAWallThere) {
  constexpr double kHeight = 1, kLong = 4096, kAt = 1.5;
  scenes::Scene scene = floor_scene({.up = {1, 0, 0}, .half = true});
  add_object(scene, "wall", quad({kAt, kHeight / 2, 0}, {0, kHeight / 2, 0}, {0, 0, kLong}));
  expect_shares(scene,
                [&](const glm::dvec3& p) {
                  const double far = kAt - p.x;
                  // The visible part goes from the edge up to the zenith: cos φ of the half dome, which itself is 1/2.
                  return far > 0 ? far / std::hypot(far, kHeight) : 1.0;
                },
                {1e-5, 0.03, 0.5});
}

}  // namespace
}  // namespace penumbra::tests
