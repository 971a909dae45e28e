// SPDX-License-Identifier: Apache-2.0
#include "scenes/formats/writer.hpp"
#include "tests/unit/scenes/support.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <variant>

/// Tests that scenes written as GLB read back in single precision, and that a warning names what glTF cannot hold.
namespace penumbra::test {
namespace {

using scenes::read_scene;
using scenes::Scene;
using scenes::write_scene;

/// Returns the nearest float32 of each coordinate, as a double.
glm::dvec3 rounded(const glm::dvec3& v) {
  return glm::dvec3(glm::vec3(v));
}

TEST(GlbWriter, ReadsBackInSinglePrecision) {
  const TemporaryFolder folder;
  const Scene scene = read_scene(std::filesystem::path(PENUMBRA_SCENES) / "fusion.json");
  EXPECT_TRUE(write_scene(scene, folder / "scene.glb").empty());
  const Scene again = read_scene(folder / "scene.glb");
  ASSERT_EQ(again.soup.triangles.size(), scene.soup.triangles.size()) << "a light without a body must not get one";
  for (std::size_t i = 0; i < scene.soup.triangles.size(); ++i) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      ASSERT_EQ(again.soup.positions[again.soup.triangles[i][corner]],
                rounded(scene.soup.positions[scene.soup.triangles[i][corner]]));
    }
  }
  ASSERT_EQ(again.objects.size(), 4u);
  EXPECT_EQ(again.objects[2].name, "ring");
  EXPECT_NEAR(again.objects[2].color.x, scene.objects[2].color.x, 1e-7);
  ASSERT_EQ(again.lights.size(), 1u);
  EXPECT_EQ(again.lights[0].name, "key");
  EXPECT_FALSE(again.lights[0].two_sided);
  EXPECT_LT(glm::distance(again.lights[0].radiance, scene.lights[0].radiance), 1e-4);
  const auto &light = std::get<scenes::Rectangle>(again.lights[0].shape),
             &old = std::get<scenes::Rectangle>(scene.lights[0].shape);
  EXPECT_LT(glm::distance(light.center, old.center), 1e-6);
  EXPECT_LT(glm::distance(glm::cross(light.half_u, light.half_v), glm::cross(old.half_u, old.half_v)), 1e-6);
  ASSERT_EQ(again.cameras.size(), 1u);
  EXPECT_LT(glm::distance(again.cameras[0].eye, scene.cameras[0].eye), 1e-9);
  EXPECT_NEAR(again.cameras[0].vertical_fov, scene.cameras[0].vertical_fov, 1e-9);
  const auto direction = [](const scenes::Camera& camera) { return glm::normalize(camera.target - camera.eye); };
  EXPECT_LT(glm::distance(direction(again.cameras[0]), direction(scene.cameras[0])), 1e-9);
}

TEST(GlbWriter, NamesLossesOfGltf) {
  const TemporaryFolder folder;
  const char* const linked = "is lit only by some lights, which glTF cannot express";
  const char* const shading = "'bulb' has shadows only of some meshes, which glTF cannot express";
  for (const char* message : {linked, shading, "--lenient writes it nevertheless"})
    expect_error(ExitCode::input, message, [&] { write_scene(read_text(kEverything), folder / "scene.glb"); });
  EXPECT_TRUE(folder.names().empty());
  const auto notes = write_scene(read_text(kEverything), folder / "scene.glb", {.lenient = true});
  ASSERT_EQ(notes.size(), 4u);
  EXPECT_NE(notes[0].find(linked), std::string::npos);
  EXPECT_NE(notes[1].find(shading), std::string::npos);
  EXPECT_NE(notes[2].find("light \"rim\": glTF has no round lights; written with 64 sides"), std::string::npos);
  EXPECT_NE(notes[3].find("light \"oval\": glTF has no round lights; written with 64 sides"), std::string::npos);
  const Scene again = read_scene(folder / "scene.glb");
  for (const scenes::Object& object : read_text(kEverything).objects) {
    const auto same = std::ranges::find(again.objects, object.name, &scenes::Object::name);
    ASSERT_NE(same, again.objects.end());
    EXPECT_EQ(same->casts_shadow, object.casts_shadow) << object.name;
    EXPECT_EQ(same->receives_shadow, object.receives_shadow) << object.name;
  }
  EXPECT_EQ(again.lights.size(), 8u);
  for (const auto& light : again.lights) {
    if (light.name == "rim") {
      EXPECT_EQ(std::get<scenes::Polygon>(light.shape).vertices.size(), 64u);
    }
  }
}

/// Lights keep names that differ from those of their bodies.
TEST(GlbWriter, LightsKeepTheirNames) {
  const TemporaryFolder folder;
  const std::string panel =
      R"(, "quad": {"center": [0, 2, 0], "halfU": [1, 0, 0], "halfV": [0, 0, 1]}, "emits": "key"})";
  const auto scene = [&](const std::string& more) {
    return read_text(
        R"({"format": "penumbra-scene/1", "size": [8, 8], "camera": {"eye": [0, 1, 6], "target": [0, 1, 0], "up": [0, 1, 0],
            "verticalFov": 45}, "meshes": [{"name": "panel")" +
        panel + more +
        R"(], "lights": [{"name": "key", "rectangle": {"center": [0, 2, 0], "halfU": [1, 0, 0], "halfV": [0, 0, 1]}}]})");
  };
  EXPECT_TRUE(write_scene(scene(""), folder / "scene.glb").empty());
  const Scene again = read_scene(folder / "scene.glb");
  ASSERT_EQ(again.lights.size(), 1u);
  EXPECT_EQ(again.lights[0].name, "key");
  EXPECT_EQ(again.objects.at(0).name, "panel");
  const auto notes = write_scene(scene(R"(, {"name": "other")" + panel), folder / "scene.glb");
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("light \"key\": each of the 2 meshes"), std::string::npos) << notes[0];
  EXPECT_EQ(read_scene(folder / "scene.glb").lights.at(1).name, "key.2");
}

/// Neither the outline of a light without a body nor a dark light becomes geometry.
TEST(GlbWriter, DarkLightsLeaveNoGeometry) {
  const TemporaryFolder folder;
  Scene scene = read_text(kEverything);
  const auto dark = std::ranges::find_if(
      scene.lights, [](const auto& light) { return std::holds_alternative<scenes::Rectangle>(light.shape); });
  ASSERT_NE(dark, scene.lights.end());
  dark->radiance = glm::dvec3(0);
  const auto notes = write_scene(scene, folder / "scene.glb", {.lenient = true});
  EXPECT_TRUE(std::ranges::any_of(notes, [](const auto& note) { return note.find("is dark") != note.npos; }));
  const Scene again = read_scene(folder / "scene.glb");
  EXPECT_EQ(again.lights.size(), scene.lights.size() - 1);
  EXPECT_EQ(again.soup.triangles.size(), scene.soup.triangles.size());
}

/// Suns, spheres and spots are written as lamps of KHR_lights_punctual, with their sizes as extras.
TEST(GlbWriter, LampsReadBack) {
  const TemporaryFolder folder;
  Scene scene = read_text(kEverything);
  const auto spot = std::ranges::find(scene.lights, "spot", &scenes::AreaLight::name);
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) spot->unshaded_by.push_back(i);
  write_scene(scene, folder / "scene.glb", {.lenient = true});
  const Scene again = read_scene(folder / "scene.glb");
  int lamps = 0;
  for (const auto& light : scene.lights) {
    if (!std::holds_alternative<scenes::Sun>(light.shape) && !std::holds_alternative<scenes::Sphere>(light.shape))
      continue;
    const auto same = std::ranges::find(again.lights, light.name, &scenes::AreaLight::name);
    ASSERT_NE(same, again.lights.end()) << light.name;
    if (const auto* sun = std::get_if<scenes::Sun>(&light.shape)) {
      const auto& read = std::get<scenes::Sun>(same->shape);
      EXPECT_EQ(read.angle, sun->angle);
      EXPECT_LT(glm::distance(read.direction, sun->direction), 1e-15);
    } else {
      const auto* sphere = &std::get<scenes::Sphere>(light.shape);
      const auto& read = std::get<scenes::Sphere>(same->shape);
      EXPECT_EQ(read.center, sphere->center);
      EXPECT_EQ(read.radius, sphere->radius);
      ASSERT_EQ(read.cone.has_value(), sphere->cone.has_value());
      if (read.cone) {
        EXPECT_LT(glm::distance(read.cone->direction, sphere->cone->direction), 1e-15);
        EXPECT_NEAR(read.cone->inner, sphere->cone->inner, 1e-12);
        EXPECT_NEAR(read.cone->outer, sphere->cone->outer, 1e-12);
        EXPECT_EQ(read.cone->smooth, sphere->cone->smooth);
        EXPECT_TRUE(read.cone->smooth);
      }
    }
    ++lamps;
    EXPECT_LT(glm::distance(same->radiance, light.radiance), 1e-12 * glm::length(light.radiance)) << light.name;
  }
  EXPECT_EQ(lamps, 4);
  for (const auto& light : again.lights)
    EXPECT_EQ(light.unshaded_by.size(), light.name == "spot" ? 4 : 0) << light.name;
  EXPECT_EQ(again.cameras.at(1).shift, scene.cameras.at(1).shift);
  EXPECT_EQ(again.cameras.at(1).lens, (scenes::ThinLens{0.07, 2.3}));
}

/// Pictures, alpha, colours and normals come back, to the last bit where they are float32.
TEST(GlbWriter, SurfacesReadBack) {
  const TemporaryFolder folder;
  Scene scene = read_text(kEverything);
  std::erase_if(scene.lights, [](const auto& light) { return !light.unshaded_by.empty(); });
  for (scenes::Object& object : scene.objects) object.lit_by.reset();
  using Wrap = scenes::PictureUse::Wrap;
  scene.pictures = {{"leaf", 2, 3, {}}, {"wall", 1, 1, {{1, 2, 3, 200}}}};
  for (std::uint8_t i = 0; i < 6; ++i)
    scene.pictures[0].texels.push_back({i, static_cast<std::uint8_t>(40 * i), 255, static_cast<std::uint8_t>(50 * i)});
  scene.objects[0].picture = {0, Wrap::mirror, Wrap::clamp, true};
  scene.objects[0].alpha = {scenes::Alpha::Mode::mask, 0.9, 0.3};
  scene.objects[1].picture = {1, Wrap::repeat, Wrap::mirror, false};
  scene.objects[1].alpha = {scenes::Alpha::Mode::blend, 0.7, 0.5};
  scene.objects[2].picture = {0, Wrap::repeat, Wrap::repeat, false};
  scene.objects[2].material = "Boards";
  const std::size_t count = scene.soup.positions.size();
  scene.looks.normals.assign(count, glm::vec3(0));
  scene.looks.colors.assign(count, glm::vec4(1));
  scene.looks.places.assign(count, glm::dvec2(0));
  for (std::size_t i = 0; i < scene.soup.triangles.size(); ++i) {
    for (const std::uint32_t vertex : scene.soup.triangles[i]) {
      const float number = static_cast<float>(vertex % 64) / 64;
      if (scene.soup.object[i] == 0) scene.looks.normals[vertex] = {0, 0.6F, -0.8F};
      if (scene.soup.object[i] == 1) scene.looks.colors[vertex] = {number, 1 - number, 0.5F, 1 - number / 2};
      if (scene.soup.object[i] < 3) scene.looks.places[vertex] = {3 * number - 1, -number};
    }
  }
  EXPECT_EQ(write_scene(scene, folder / "scene.glb").size(), 2u) << "lights with 64 sides";
  const Scene again = read_scene(folder / "scene.glb");
  EXPECT_EQ(again.pictures, scene.pictures);
  ASSERT_EQ(again.objects.size(), scene.objects.size());
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    EXPECT_EQ(again.objects[i].picture, scene.objects[i].picture) << i;
    EXPECT_EQ(again.objects[i].alpha, scene.objects[i].alpha) << i;
  }
  EXPECT_EQ(again.objects[2].material, "Boards");
  ASSERT_EQ(again.soup.triangles.size(), scene.soup.triangles.size());
  std::size_t differing = 0;
  for (std::size_t i = 0; i < scene.soup.triangles.size(); ++i) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t a = scene.soup.triangles[i][corner], b = again.soup.triangles[i][corner];
      differing += scene.looks.colors[a] != again.looks.colors[b];
      differing += scene.looks.places[a] != again.looks.places[b];
      differing += glm::distance(scene.looks.normals[a], again.looks.normals[b]) > 1e-6F;
    }
  }
  EXPECT_EQ(differing, 0u);
}

}  // namespace
}  // namespace penumbra::test
