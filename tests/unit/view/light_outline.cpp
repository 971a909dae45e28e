// SPDX-License-Identifier: Apache-2.0
// Tests outlines of occluders projected from a point onto a light against places found by hand.
#include "app/view/light_outline.hpp"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <numbers>

namespace penumbra::app {
namespace {

/// A triangle at height 1, and a floor below it that carries the origin.
scenes::Scene scene_of(const scenes::LightShape& shape) {
  scenes::Scene scene;
  scene.soup.positions = {{-9, 0, 9}, {9, 0, 9}, {0, 0, -9}, {0, 1, 0}, {0.25, 1, 0}, {0, 1, 0.5}};
  scene.soup.triangles = {{0, 1, 2}, {3, 4, 5}};
  scene.soup.object = {0, 1};
  scene.soup.source_face = {0, 0};
  scene.objects.resize(2);
  scene.lights.resize(1);
  scene.lights[0].name = "key";
  scene.lights[0].shape = shape;
  return scene;
}

std::optional<LightOutline> outline_of(const scenes::Scene& scene, const glm::dvec3& point = {0, 0, 0}) {
  return light_outline(scene, scene.lights.front(), {point, 0});
}

void expect_places(const std::vector<glm::dvec2>& found, const std::vector<glm::dvec2>& wanted) {
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_NEAR(found[i].x, wanted[i].x, 1e-12) << i;
    EXPECT_NEAR(found[i].y, wanted[i].y, 1e-12) << i;
  }
}

TEST(LightOutline, OfARectangleIsFlattenedFromThePoint) {
  // A light at height 4, two wide, shining down: seen from the origin, an occluder at height 1 appears four times as
  // large.
  const auto scene = scene_of(scenes::Rectangle{{0, 4, 0}, {2, 0, 0}, {0, 0, 4}});
  const auto outline = outline_of(scene);
  ASSERT_TRUE(outline);
  EXPECT_EQ(outline->rim, LightOutline::Rim::square);
  ASSERT_EQ(outline->blockers.size(), 1U);  // the floor that carries the point is not a blocker
  expect_places(outline->blockers[0], {{0, 0}, {0.5, 0}, {0, 0.5}});
  const auto beside = outline_of(scene, {0.9, 0, 0});  // x = 0 is projected to 0.9 + 4 (0 - 0.9) = -2.7
  ASSERT_TRUE(beside);
  expect_places(beside->blockers[0], {{-1.35, 0}, {-0.85, 0}, {-1.35, 0.5}});
}

TEST(LightOutline, IsOfWhatIsBetween) {
  auto scene = scene_of(scenes::Rectangle{{0, 4, 0}, {2, 0, 0}, {0, 0, 4}});
  EXPECT_FALSE(outline_of(scene, {0, 5, 0}));  // the point is behind the light
  for (const double height : {-1.0, 4.5}) {
    for (std::size_t i = 3; i < 6; ++i) scene.soup.positions[i].y = height;
    EXPECT_TRUE(outline_of(scene)->blockers.empty()) << height;
  }
  scene.soup.positions[3] = {0, 2, 0};
  scene.soup.positions[4] = {0.5, 2, 0};
  scene.soup.positions[5] = {0, 6, 0.5};  // behind the light: cut at the light's plane, half way
  expect_places(outline_of(scene)->blockers[0], {{0, 0}, {0.5, 0}, {0.125, 0.0625}, {0, 0.0625}});
  scene.objects[1].casts_shadow = false;
  EXPECT_TRUE(outline_of(scene)->blockers.empty());
}

TEST(LightOutline, OfRoundLightsIsACircle) {
  // A sphere of radius 1 at distance 2 is seen under a half angle of 30 degrees.
  const double tangent = std::numbers::sqrt3 / 3;
  for (const scenes::LightShape& shape :
       {scenes::LightShape(scenes::Sphere{{0, 2, 0}, 1}), scenes::LightShape(scenes::Sun{{0, -1, 0}, 60})}) {
    const auto outline = outline_of(scene_of(shape));
    ASSERT_TRUE(outline);
    EXPECT_EQ(outline->rim, LightOutline::Rim::circle);
    ASSERT_EQ(outline->blockers.size(), 1U);
    const auto& places = outline->blockers[0];
    EXPECT_NEAR(glm::length(places[1] - places[0]), 0.25 / tangent, 1e-12);
    EXPECT_NEAR(glm::length(places[2] - places[0]), 0.5 / tangent, 1e-12);
  }
  EXPECT_FALSE(outline_of(scene_of(scenes::Dome{})));
}

TEST(LightOutline, OfAPolygonHasItsCorners) {
  const auto outline = outline_of(scene_of(scenes::Polygon{{{-2, 4, -4}, {2, 4, -4}, {2, 4, 4}, {-2, 4, 4}}}));
  ASSERT_TRUE(outline);
  expect_places(outline->corners, {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}});
  expect_places(outline->blockers[0], {{0, 0}, {0.5, 0}, {0, 0.5}});
}

}  // namespace
}  // namespace penumbra::app
