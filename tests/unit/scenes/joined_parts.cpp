// SPDX-License-Identifier: Apache-2.0
// Tests scenes::joined: a scene that is divided into parts and joined again equals the original.
#include "scenes/joined_parts.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace penumbra::scenes {
namespace {

/// Returns three objects of one to three triangles and two lights. The second object has normals and a picture, and is
/// the body of the first light.
Scene three_objects() {
  Scene scene;
  for (std::uint32_t object = 0; object < 3; ++object) {
    scene.objects.push_back({.name = std::string(1, static_cast<char>('a' + object)), .emits = {}});
    for (std::uint32_t i = 0; i <= object; ++i) {
      const auto first = static_cast<std::uint32_t>(scene.soup.positions.size());
      for (const double x : {0.0, 1.0, 2.0}) scene.soup.positions.emplace_back(x, object, i);
      scene.soup.triangles.push_back({first, first + 1, first + 2});
      scene.soup.object.push_back(object);
      scene.soup.source_face.push_back(i);
    }
  }
  scene.looks.normals.assign(scene.soup.positions.size(), glm::vec3(0));
  for (std::size_t i = 3; i < 9; ++i) scene.looks.normals[i] = {0, 0, 1};
  scene.pictures.push_back({.file = "wood", .width = 1, .height = 1, .texels = {{1, 2, 3, 4}}});
  scene.objects[1].picture = PictureUse{};
  scene.objects[1].emits = 0;
  for (const char* name : {"panel", "lamp"}) scene.lights.push_back({.name = name, .shape = Sphere{{0, 5, 0}, 1}});
  return scene;
}

void expect_same(const Scene& found, const Scene& wanted) {
  EXPECT_EQ(found.soup.positions, wanted.soup.positions);
  EXPECT_EQ(found.soup.triangles, wanted.soup.triangles);
  EXPECT_EQ(found.soup.object, wanted.soup.object);
  EXPECT_EQ(found.soup.source_face, wanted.soup.source_face);
  EXPECT_EQ(found.looks.normals, wanted.looks.normals);
  ASSERT_EQ(found.objects.size(), wanted.objects.size());
  for (std::size_t i = 0; i < wanted.objects.size(); ++i) {
    EXPECT_EQ(found.objects[i].name, wanted.objects[i].name);
    EXPECT_EQ(found.objects[i].emits, wanted.objects[i].emits);
    EXPECT_EQ(found.objects[i].picture, wanted.objects[i].picture);
  }
  ASSERT_EQ(found.lights.size(), wanted.lights.size());
  for (std::size_t i = 0; i < wanted.lights.size(); ++i) EXPECT_EQ(found.lights[i].name, wanted.lights[i].name);
}

TEST(JoinedParts, AreTheSceneThatWasCut) {
  const Scene scene = three_objects();
  const std::vector<ScenePart> parts = {{&scene, 0, 1, 0, 0}, {&scene, 1, 1, 0, 1}, {&scene, 2, 1, 1, 1}};
  const Scene whole = joined(parts, true);
  expect_same(whole, scene);
  EXPECT_EQ(whole.pictures, scene.pictures);  // stored once, though there are three parts
  const Scene without = joined(parts, false);
  EXPECT_TRUE(without.soup.triangles.empty());
  EXPECT_EQ(without.objects[1].emits, scene.objects[1].emits);
}

TEST(JoinedParts, StandInTheirOrder) {
  const Scene scene = three_objects();
  const std::vector<ScenePart> parts = {{&scene, 2, 1, 1, 1}, {&scene, 1, 1, 0, 1}};
  const Scene whole = joined(parts, true);
  EXPECT_EQ(whole.soup.object, (std::vector<std::uint32_t>{0, 0, 0, 1, 1}));
  EXPECT_EQ(whole.soup.positions.front(), glm::dvec3(0, 2, 0));
  EXPECT_EQ(whole.soup.triangles.back(), (mesh::Triangle{12, 13, 14}));
  EXPECT_EQ(whole.objects[1].emits, 1U);
  EXPECT_EQ(whole.looks.normals[8], glm::vec3(0));
  EXPECT_EQ(whole.looks.normals[9], glm::vec3(0, 0, 1));
}

TEST(JoinedParts, HaveNamesOfTheirOwnAndShadowsOrNone) {
  const Scene one = three_objects(), other = three_objects();
  const std::vector<ScenePart> parts = {{&one, 0, 3, 0, 2}, {&other, 0, 3, 0, 2, false}};
  const Scene whole = joined(parts, true);
  EXPECT_EQ(whole.objects[3].name, "a.2");
  EXPECT_EQ(whole.lights[2].name, "panel.2");
  EXPECT_EQ(whole.objects[4].picture->picture, 1U);
  EXPECT_TRUE(whole.lights[1].unshaded_by.empty());
  EXPECT_EQ(whole.lights[3].unshaded_by, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
}

TEST(JoinedParts, NumberPicturesByObjectsAlone) {
  const Scene old = three_objects(), edited = three_objects();
  const Scene lamps = three_objects();
  const ScenePart mesh{&old, 1, 1, 0, 1}, edited_mesh{&edited, 1, 1, 0, 1};
  // The lamp comes first, from the file that the second mesh also comes from; then only the lamp is replaced.
  const std::vector<ScenePart> before = {{&old, 0, 0, 1, 1}, edited_mesh, mesh};
  const std::vector<ScenePart> after = {{&lamps, 0, 0, 1, 1}, edited_mesh, mesh};
  const Scene whole = joined(before, true), without = joined(after, false);
  ASSERT_EQ(whole.pictures.size(), 2U);
  EXPECT_EQ(whole.objects[0].picture->picture, 0U);
  for (const std::size_t object : {0U, 1U}) EXPECT_EQ(without.objects[object].picture, whole.objects[object].picture);
}

}  // namespace
}  // namespace penumbra::scenes
