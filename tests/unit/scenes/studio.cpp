// SPDX-License-Identifier: Apache-2.0
// Tests the studio that is put around meshes and scenes without lights.

#include "scenes/formats/reader.hpp"
#include "scenes/studio.hpp"
#include "tests/unit/scenes/support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace penumbra::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// A tetrahedron two units tall, whose lowest corner is at y = 3.
constexpr const char* kTetrahedron = "v 0 5 0\nv -1 4 -1\nv 1 4 -1\nv 0 3 1\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n";

scenes::Scene read(const char* obj, const scenes::StudioWish& wish = {}) {
  const TemporaryFolder folder;
  return scenes::read_scene(folder.write("thing.obj", obj), {.needs_light = !wish.never, .studio = wish});
}

TEST(Studio, AMeshGetsALightAFloorAndACamera) {
  const scenes::Scene scene = read(kTetrahedron);
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.objects[0].name, "thing");
  EXPECT_EQ(scene.objects[1].name, "floor");
  ASSERT_EQ(scene.soup.triangles.size(), 6U);
  for (std::size_t i = 4; i < 6; ++i) {
    for (const std::uint32_t vertex : scene.soup.triangles[i]) EXPECT_EQ(scene.soup.positions[vertex].y, 3);
  }
  EXPECT_THAT(scene.warnings,
              Contains(HasSubstr("one soft rectangle light, a floor below it, a camera that frames it")));

  // The light faces the middle, and gives a surface there that faces the light an irradiance of pi.
  ASSERT_EQ(scene.lights.size(), 1U);
  const auto& light = std::get<scenes::Rectangle>(scene.lights[0].shape);
  const glm::dvec3 middle(0, 4, 0), normal = glm::cross(light.half_u, light.half_v);
  const glm::dvec3 to_middle = middle - light.center;
  EXPECT_NEAR(glm::dot(glm::normalize(normal), glm::normalize(to_middle)), 1, 1e-12);
  EXPECT_GT(light.center.y, 5);
  EXPECT_NEAR(scene.lights[0].radiance.x * 4 * glm::length(normal) / glm::dot(to_middle, to_middle), std::numbers::pi,
              1e-9);

  // The sphere around the mesh is within the camera's cone, and touches it.
  ASSERT_EQ(scene.cameras.size(), 1U);
  const scenes::Camera& camera = scene.cameras[0];
  EXPECT_EQ(camera.target, middle);
  const double sine =
      std::sqrt(3.0) / glm::distance(camera.eye, middle);  // the sphere's radius is half of the box's diagonal
  EXPECT_NEAR(std::asin(sine) * 180 / std::numbers::pi, camera.vertical_fov / 2, 1e-9);

  // In a picture half as wide as high, the mesh is within the cone of half the width.
  const scenes::Camera upright = read(kTetrahedron, {.aspect = 0.5}).cameras[0];
  EXPECT_NEAR(std::asin(std::sqrt(3.0) / glm::distance(upright.eye, middle)),
              std::atan(0.5 * std::tan(camera.vertical_fov / 360 * std::numbers::pi)), 1e-12);
}

// While the scene moves between keys, the floor and the camera stay where they are at rest.
TEST(Studio, StandsStillWhileASceneMoves) {
  const scenes::Scene rest = read(kTetrahedron, {.never = true, .fit_camera = "fit"});
  scenes::Scene moved = rest;
  moved.cameras.clear();
  for (glm::dvec3& p : moved.soup.positions) p += glm::dvec3(3, 7, 0);
  scenes::put_in_studio(moved, rest, {});
  ASSERT_EQ(moved.soup.triangles.size(), 6U);
  EXPECT_EQ(moved.soup.positions[moved.soup.triangles[5][0]].y, 3);
  EXPECT_EQ(moved.cameras.at(0).eye, rest.cameras.at(0).eye);
}

TEST(Studio, WhatLiesOnAFloorGetsNoOther) {
  const std::string ground = "v -2 3 -2\nv 2 3 -2\nv 2 3 2\nv -2 3 2\nf 5 8 7 6\n";
  EXPECT_EQ(read((kTetrahedron + ground).c_str()).objects.size(), 1U);
  EXPECT_EQ(read(kTetrahedron, {.floor = false}).objects.size(), 1U);
  const std::string bottom =
      "v -2 3 -2\nv 2 3 -2\nv 2 3 2\nv -2 3 2\nf 5 6 7 8\n";  // the body's own underside, which faces down
  EXPECT_EQ(read((kTetrahedron + bottom).c_str()).objects.size(), 2U);
}

TEST(Studio, LightsAndCamerasAsWished) {
  using Kind = scenes::AddedLight::Kind;
  scenes::Camera own;
  own.name = "own";
  own.eye = {0, 4, 9};
  own.target = {0, 4, 0};
  const scenes::Scene scene =
      read(kTetrahedron,
           {.lights = {{Kind::sphere, {0, 8, 0}, 0.5}, {Kind::sphere, {3, 8, 0}, 0.25}, {Kind::sun, {0, -2, 0}, 0}},
            .fit_camera = "fit",
            .camera = own});
  ASSERT_EQ(scene.lights.size(), 3U);
  EXPECT_EQ(scene.lights[0].name, "sphere");
  EXPECT_EQ(scene.lights[1].name, "sphere 2");
  EXPECT_EQ(std::get<scenes::Sphere>(scene.lights[1].shape).radius, 0.25);
  EXPECT_EQ(std::get<scenes::Sun>(scene.lights[2].shape).direction, glm::dvec3(0, -1, 0));
  EXPECT_NEAR(scene.lights[2].radiance.x, std::numbers::pi, 1e-12);  // irradiance of a sun without extent
  ASSERT_EQ(scene.cameras.size(), 2U);
  EXPECT_EQ(scene.cameras[0].name, "own");
  EXPECT_EQ(scene.cameras[1].name, "fit");
  EXPECT_EQ(scene.objects.size(), 2U);  // the floor is still the studio's
}

TEST(Studio, ScenesWithLightsStayAsTheyAre) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.write("scene.json", scene_text());
  const scenes::Scene plain = scenes::read_scene(file);
  EXPECT_THAT(plain.warnings, IsEmpty());
  const scenes::Scene with = scenes::read_scene(file, {.studio = {.always = true}});
  EXPECT_EQ(with.lights.size(), plain.lights.size() + 1);
  EXPECT_EQ(with.lights[0].name, plain.lights[0].name);  // the scene's own light stays the first
  expect_error(ExitCode::input, "there is no light in the scene",
               [&] { scenes::read_scene(folder.write("thing.obj", kTetrahedron), {.studio = {.never = true}}); });
}

}  // namespace
}  // namespace penumbra::test
