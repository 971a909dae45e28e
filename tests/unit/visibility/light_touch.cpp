// SPDX-License-Identifier: Apache-2.0
// Tests which light samples are touched by something in the light's plane.

#include "tests/unit/visibility/scenes.hpp"
#include "visibility/lights/light_touch.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace penumbra {
namespace {

const glm::dvec3 kCenter(-2.6, 4.2, 2.4), kU(0.5208, 0, 0.6076),
    kV(-0.4416, -0.5498, 0.3784);  // tilted: in float the light's points are off its plane

visibility::LightTouch touch_of(const scenes::AreaLight& light, const std::vector<tests::Corners>& occluder) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  tests::add_object(scene, "occluder", occluder);
  scene.lights.push_back(light);
  const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
  const visibility::Light made = visibility::make_light(scene, 0, floats.origin, {});
  return visibility::find_touch(floats, visibility::make_triangle_tree(floats), made);
}

TEST(LightTouch, NothingNearTouchesNothing) {
  const scenes::AreaLight light = tests::rectangle_light(kCenter, kU, kV);
  EXPECT_TRUE(touch_of(light, tests::quad({0, 1, 0}, {1, 0, 0}, {0, 0, -1})).empty());
  // Quads behind the light and in front of it, a quarter of the normal away.
  const glm::dvec3 n = glm::cross(kU, kV);
  EXPECT_TRUE(touch_of(light, tests::quad(kCenter - 0.25 * n, kU, kV)).empty());
  EXPECT_TRUE(touch_of(light, tests::quad(kCenter + 0.25 * n, kU, kV)).empty());
}

TEST(LightTouch, PanelOfATiltedLightTouchesWhatItCovers) {
  const scenes::AreaLight light = tests::rectangle_light(kCenter, kU, kV);
  EXPECT_EQ(touch_of(light, tests::quad(kCenter, 2.0 * kU, 2.0 * kV)).samples.size(), 256U);
  // A quad over the light's left half touches eight columns, and samples at its border.
  const visibility::LightTouch half = touch_of(light, tests::quad(kCenter - kU, kU, 2.0 * kV));
  EXPECT_GE(half.samples.size(), 120U);
  EXPECT_LE(half.samples.size(), 136U);
  for (const std::uint32_t sample : half.samples) EXPECT_LE(sample % 16, 8U);
  // A quad next to the light touches no sample, but flat segments to samples may meet it.
  const visibility::LightTouch beside = touch_of(light, tests::quad(kCenter + 2.5 * kU, kU, kV));
  EXPECT_TRUE(beside.samples.empty());
  EXPECT_TRUE(beside.any_near);
}

TEST(LightTouch, CeilingAroundALightIsSafe) {
  const std::vector<tests::Corners> ceiling = tests::quad({0, 5, 0}, {4, 0, 0}, {0, 0, -4});
  EXPECT_TRUE(touch_of(tests::rectangle_light({0.1, 5, 0.3}, {0.7, 0, 0}, {0, 0, 0.4}), ceiling).empty());
}

TEST(LightTouch, WhatPassesThroughTouchesWhereItDoes) {
  // A wall along v through one light sample.
  scenes::Scene scene;
  scene.lights.push_back(tests::rectangle_light(kCenter, kU, kV));
  const visibility::Light light = visibility::make_light(scene, 0, glm::dvec3(0), {});
  constexpr std::uint32_t kSample = 7 * 16 + 9;
  const glm::dvec3 n = glm::normalize(glm::cross(kU, kV)), at(light.points[kSample]);
  const visibility::LightTouch touch = touch_of(scene.lights[0], tests::quad(at, 3.0 * kV, n));
  EXPECT_TRUE(touch.any_near);
  EXPECT_NE(std::ranges::find(touch.samples, kSample), touch.samples.end());
  EXPECT_LE(touch.samples.size(), 4U);  // each row is shifted by another share of a cell
}

}  // namespace
}  // namespace penumbra
