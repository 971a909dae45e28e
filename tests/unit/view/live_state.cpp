// SPDX-License-Identifier: Apache-2.0
// Tests what messages from the page, and a changed file, do to the state.
#include "app/view/live_state.hpp"

#include "app/view/light_json.hpp"
#include "base/error.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace penumbra::app {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;

scenes::Scene scene_of_two() {
  scenes::Scene scene;
  scene.name = "two";
  for (const char* name : {"key", "rim"}) {
    scenes::AreaLight light;
    light.name = name;
    light.shape = scenes::Sphere{{0, 4, 0}, 1};
    scene.lights.push_back(light);
  }
  for (const char* name : {"front", "side"}) {
    scenes::Camera camera;
    camera.name = name;
    camera.eye = {0, 0, 5};
    scene.cameras.push_back(camera);
  }
  return scene;
}

json sphere(double height) {
  return {{"sphere", {{"center", {0, height, 0}}, {"radius", 1}}}, {"radiance", {1, 1, 1}}};
}

TEST(LiveState, LightsShineUnlessTheyAreOffOrAnotherIsAlone) {
  LiveState state = live_state(scene_of_two(), "");
  EXPECT_THAT(lights_on(state), ElementsAre("key", "rim"));
  EXPECT_EQ(apply(state, {{"type", "lights"}, {"off", {"rim"}}, {"solo", ""}}), LiveChange::picture);
  EXPECT_THAT(lights_on(state), ElementsAre("key"));
  apply(state, {{"type", "lights"}, {"off", {"rim"}}, {"solo", "rim"}});
  EXPECT_THAT(lights_on(state), ElementsAre("rim"));
  apply(state, {{"type", "lights"}, {"off", {"rim", "key"}}, {"solo", ""}});
  EXPECT_THAT(lights_on(state), IsEmpty());
  EXPECT_THROW(apply(state, {{"type", "lights"}, {"off", {"moon"}}, {"solo", ""}}), InputError);
}

TEST(LiveState, WhatIsRefusedChangesNothing) {
  LiveState state = live_state(scene_of_two(), "side");
  const auto before = to_json(state);
  for (const json& wrong :
       {json{{"type", "light"}, {"name", "key"}, {"light", {{"sphere", {{"center", {0, 0, 0}}, {"radius", 0}}}}}},
        json{{"type", "lights"}, {"off", {"key"}}, {"solo", 3}}, json{{"type", "camera"}, {"name", "back"}},
        json{{"type", "display"}, {"channel", "v"}, {"stops", "many"}}, json{{"type", "display"}, {"stops", 1e9}},
        json{{"type", "size"}, {"width", 5}, {"height", 0}}, json{{"type", "none"}}, json(7), json::object()})
    EXPECT_THROW(apply(state, wrong), Error) << wrong;
  EXPECT_EQ(to_json(state), before);
}

TEST(LiveState, BodiesKeepTheirLightsWhereTheyAre) {
  scenes::Scene scene = scene_of_two();
  scene.objects.emplace_back();
  scene.objects.back().emits = 0;
  LiveState state = live_state(std::move(scene), "");
  EXPECT_THROW(apply(state, {{"type", "light"}, {"name", "key"}, {"light", sphere(3)}}), InputError);
  apply(state, {{"type", "light"}, {"name", "key"}, {"light", sphere(4)}});  // only another radiance
  EXPECT_EQ(state.scene.lights[0].radiance, glm::dvec3(1));
  apply(state, {{"type", "light"}, {"name", "rim"}, {"light", sphere(3)}});
}

TEST(LiveState, OfANewFileWhatItSaysOtherwiseIsTaken) {
  const scenes::Scene before = scene_of_two();
  LiveState state = live_state(before, "front");
  apply(state, {{"type", "light"}, {"name", "key"}, {"light", sphere(1)}});
  apply(state, {{"type", "light"}, {"name", "rim"}, {"light", sphere(2)}});
  apply(state, {{"type", "camera"}, {"camera", {{"eye", {1, 1, 1}}, {"target", {0, 0, 0}}}}});
  scenes::Scene now = before;
  std::get<scenes::Sphere>(now.lights[1].shape).center.y = 9;
  const LiveState made = reloaded(state, before, now);
  EXPECT_EQ(std::get<scenes::Sphere>(made.scene.lights[0].shape).center.y, 1);  // moved by hand
  EXPECT_EQ(std::get<scenes::Sphere>(made.scene.lights[1].shape).center.y, 9);  // from the changed file
  EXPECT_EQ(made.camera.eye, glm::dvec3(1));
  now.cameras[0].eye = {0, 0, 7};
  EXPECT_EQ(reloaded(state, before, now).camera.eye, glm::dvec3(0, 0, 7));
  now.lights.pop_back();
  state.off = {"rim"};
  state.solo = state.display.light = "rim";
  const LiveState fewer = reloaded(state, before, now);
  EXPECT_THAT(fewer.off, IsEmpty());
  EXPECT_EQ(fewer.solo, "");
  EXPECT_EQ(fewer.display.light, "key");
}

TEST(LiveState, MeshesAreTheSameUnlessATriangleOrASurfaceDiffers) {
  scenes::Scene scene = scene_of_two();
  scene.objects.emplace_back();
  scene.soup = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {0}, {0}};
  scenes::Scene lit = scene;
  lit.lights.front().radiance = glm::dvec3(3);
  lit.cameras.pop_back();
  EXPECT_TRUE(same_meshes(scene, lit));
  const std::vector<void (*)(scenes::Scene&)> changes = {
      [](scenes::Scene& one) { one.soup.positions[1].x = 2; },
      [](scenes::Scene& one) {
        one.soup.triangles[0] = {1, 0, 2};
      },
      [](scenes::Scene& one) { one.objects[0].color.x = 0.1; },
      [](scenes::Scene& one) { one.objects[0].casts_shadow = false; },
      [](scenes::Scene& one) { one.objects[0].emits = 1; },
      [](scenes::Scene& one) { one.looks.normals.resize(3); },
      [](scenes::Scene& one) { one.pictures.emplace_back(); },
      [](scenes::Scene& one) { one.origin = glm::dvec3(1); },
      [](scenes::Scene& one) { one.objects.emplace_back(); },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    scenes::Scene changed = lit;
    changes[i](changed);
    EXPECT_FALSE(same_meshes(scene, changed)) << i;
  }
  const scenes::Scene whole = with_meshes(lit, scene);
  EXPECT_TRUE(same_meshes(whole, scene));
  EXPECT_EQ(whole.lights.front().radiance, glm::dvec3(3));
}

}  // namespace
}  // namespace penumbra::app
