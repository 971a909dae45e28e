// SPDX-License-Identifier: Apache-2.0
// Tests the search for surfaces that let light through and may take part: specks that reach into the pyramid from p to
// a light by a ten-thousandth of it, or stay outside by as much. All specks met on the way to a light sample must have
// been found.
#include "visibility/alpha/alpha_reach.hpp"

#include "tests/unit/visibility/scenes.hpp"
#include "visibility/alpha/alpha_filter.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <variant>
#include <vector>

namespace penumbra::visibility {
namespace {

using scenes::Alpha;

/// A floor at y = 0 with a view sample in its middle, under a light.
struct Floor {
  scenes::Scene scene;
  ViewSamples samples;

  explicit Floor(const scenes::LightShape& shape) {
    scene.origin = glm::dvec3(0);
    tests::add_quad(scene, {0, 0, 0}, {8, 0, 0}, {0, 0, -8});
    scene.lights.push_back(tests::ceiling_light(4, 1));
    scene.lights[0].shape = shape;
    look_at({glm::vec3(0)});
  }
  void look_at(const std::vector<glm::vec3>& points, std::uint32_t width = 1) {
    const auto [a, b, c] = make_scene_floats(scene).corners(0);
    samples.p = points;
    samples.triangle.assign(points.size(), 0);
    samples.n.assign(points.size(), glm::vec3(0, 1, 0));
    samples.facing.assign(points.size(), glm::cross(b - a, c - a).y > 0 ? std::int8_t{1} : std::int8_t{-1});
    samples.width = width;
    samples.height = static_cast<std::uint32_t>(points.size()) / width;
  }
  /// Returns the result of the search with only these specks in the scene.
  [[nodiscard]] std::vector<std::uint8_t> reached(const std::vector<tests::Corners>& specks) const {
    scenes::Scene with = scene;
    tests::add_object(with, "specks", specks).alpha = {Alpha::Mode::blend, 0.5, 0.5};
    const SceneFloats floats = make_scene_floats(with);
    const Light light = make_light(with, 0, floats.origin, {256, 0, 0, SamplePattern::sobol, 0});
    return AlphaReach(floats).reached(samples, light, classify_pixels(floats, samples, light));
  }
  [[nodiscard]] bool reached_by(const tests::Corners& speck) const { return !reached({speck}).empty(); }
};

struct Outline {
  scenes::LightShape shape;
  glm::dvec3 middle;                // of the light, or of its directions
  std::vector<glm::dvec3> corners;  // corners of a convex outline
  bool exact = true;                // whether the outline is that of the light itself, and not one around it
};

std::vector<Outline> outlines() {
  const glm::dvec3 c(0.5, 4, -0.25), u(1, 0.25, 0), v(0, 0.25, 0.75);
  const std::vector<glm::dvec3> square = {c - u - v, c + u - v, c + u + v, c - u + v};
  const std::vector<glm::dvec3> kite = {{-1, 3, 0}, {0, 3, -0.5}, {2, 3, 0}, {0, 3, 1}};
  const auto ring = [](const glm::dvec3& middle, const glm::dvec3& a, const glm::dvec3& b) {
    std::vector<glm::dvec3> points;
    for (int i = 0; i < 64; ++i)
      points.push_back(middle + std::cos(i * 0.0981747704) * a + std::sin(i * 0.0981747704) * b);
    return points;
  };
  const glm::dvec3 up(0, 3, 0), x(1, 0, 0), z(0, 0, 1);
  const double tangent = std::tan(std::numbers::pi / 12), rim = 0.8 * std::sqrt(0.96);  // r √(d² − r²) / d, r 0.8, d 4
  const glm::dvec3 ball(0, 4 - 0.16, 0);                                                // d − r² / d
  return {{scenes::Rectangle{c, u, v}, c, square},
          {scenes::Polygon{kite}, {0.2, 3, 0.1}, kite},
          {scenes::Disk{up, {0, -1, 0}, 0.7}, up, ring(up, 0.7 * x, 0.7 * z), false},
          {scenes::Sphere{{0, 4, 0}, 0.8}, ball, ring(ball, rim * x, rim * z), false},
          {scenes::Sun{{0, -1, 0}, 30}, {0, 1, 0}, ring({0, 1, 0}, tangent * x, tangent * z), false}};
}

TEST(AlphaReaches, SpecksThatReachIntoThePyramidByATenThousandth) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> real(0, 0.95);
  for (const Outline& light : outlines()) {
    const Floor floor(light.shape);
    for (std::size_t i = 0; i < 40; ++i) {
      const glm::dvec3 &a = light.corners[i % light.corners.size()], &b = light.corners[(i + 1) % light.corners.size()];
      const glm::dvec3 edge = glm::mix(a, b, real(random));
      const double t = (0.3 + 0.7 * real(random)) * (std::holds_alternative<scenes::Sun>(light.shape) ? 6.0 : 1.0);
      // Away from the pyramid: perpendicular to its side, with a part along the side.
      glm::dvec3 away = glm::normalize(glm::cross(a, b));
      if (glm::dot(away, light.middle) > 0) away = -away;
      const glm::dvec3 along = glm::normalize(b - a);
      const auto speck = [&](double share) {
        const glm::dvec3 tip = t * (light.middle + share * (edge - light.middle));
        return tests::Corners{tip, tip + 0.2 * away + 0.3 * along, tip + 0.3 * away - 0.1 * along + 0.02 * edge};
      };
      EXPECT_TRUE(floor.reached_by(speck(0.9999))) << i;
      if (light.exact) {
        EXPECT_FALSE(floor.reached_by(speck(1.0001))) << i;
      } else {
        EXPECT_FALSE(floor.reached_by(speck(1.5))) << i << ": the search uses a square around the outline";
      }
    }
  }
}

/// Specks between p and the light count, but none below the floor, behind the light, or in p's plane.
TEST(AlphaReaches, FromTheFloorToTheLight) {
  const auto at = [](double height) {
    return tests::Corners{glm::dvec3(-1, height, -1), glm::dvec3(1, height, -1), glm::dvec3(0, height, 1)};
  };
  for (const Outline& light : outlines()) {
    Floor floor(light.shape);
    if (std::holds_alternative<scenes::Rectangle>(light.shape))
      floor.scene.lights[0].shape = scenes::Rectangle{{0, 4, 0}, {1, 0, 0}, {0, 0, 1}};
    const bool endless = std::holds_alternative<scenes::Sun>(light.shape);
    const double end =
        std::holds_alternative<scenes::Polygon>(light.shape) || std::holds_alternative<scenes::Disk>(light.shape)
            ? 3
            : light.middle.y;
    const double top = std::holds_alternative<scenes::Rectangle>(light.shape) ? 4 : end;
    for (const double height : {-4.0, -0.001, 0.0}) EXPECT_FALSE(floor.reached_by(at(height))) << height;
    for (const double height : {0.001, 1.0, 0.9999 * top}) EXPECT_TRUE(floor.reached_by(at(height))) << height;
    EXPECT_EQ(floor.reached_by(at(1.0001 * top)), endless);
    EXPECT_EQ(floor.reached_by(at(100)), endless);
    // The part above the floor counts where a triangle passes through the floor.
    EXPECT_TRUE(floor.reached_by({glm::dvec3(0, 0.1, 0), glm::dvec3(1, -9, 1), glm::dvec3(-1, -9, 1)}));
  }
}

/// Every speck that is met on the way to a light sample was found, in any pixel of any block.
TEST(AlphaReaches, WhateverALightSampleMeets) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> real(-1, 1);
  const auto point = [&] { return glm::dvec3(real(random), real(random), real(random)); };
  for (const Outline& light : outlines()) {
    Floor floor(light.shape);
    std::vector<glm::vec3> points;
    for (int row = 0; row < 40; ++row)
      for (int column = 0; column < 50; ++column) points.emplace_back(0.1 * column - 2.45, 0, 0.1 * row - 1.95);
    floor.look_at(points, 50);
    std::size_t met = 0, foreseen = 0;
    for (int round = 0; round < 24; ++round) {
      // Specks are somewhere in between, or close to some view sample.
      const bool low = round % 2 == 0;
      const glm::dvec3 middle = low ? glm::dvec3(2.5, 0.02, 2) * point() : glm::dvec3(0, 2, 0) + 1.5 * point();
      const double size = low ? 0.15 : 0.4;
      std::vector<tests::Corners> specks;
      for (int i = 0; i < 3; ++i)
        specks.push_back({middle + size * point(), middle + size * point(), middle + size * point()});
      std::vector<std::uint8_t> reached = floor.reached(specks);
      reached.resize(points.size());
      scenes::Scene scene = floor.scene;
      tests::add_object(scene, "specks", specks).alpha = {Alpha::Mode::mask, 1, 0.5};
      const SceneFloats floats = make_scene_floats(scene);
      const Light samples = make_light(scene, 0, floats.origin, {64, 0, 0, SamplePattern::sobol, 0});
      std::vector<std::uint32_t> masks(2 * points.size(), 0xffffffffu);
      AlphaFilter(floats).filter(floor.samples, samples, 0, {masks, {}, {}});
      for (std::size_t i = 0; i < points.size(); ++i) {
        const bool meets = (masks[2 * i] & masks[2 * i + 1]) != 0xffffffffu;
        ASSERT_LE(meets, reached[i] != 0) << round << ", pixel " << i;
        met += meets ? 1 : 0;
        foreseen += reached[i];
      }
    }
    EXPECT_GT(met, 1000u);
    if (light.exact) {
      EXPECT_LE(foreseen, 2 * met) << "only specks that touch the light between light samples may be found in addition";
    }
  }
}

}  // namespace
}  // namespace penumbra::visibility
