// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/scenes/support.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <variant>

/// Tests how the program understands the contents of a scene file.
namespace penumbra::test {
namespace {

using scenes::read_scene;

TEST(JsonScene, ReadsMeshesAndLightsOfEveryKind) {
  const TemporaryFolder folder;
  (void)folder.write("statue.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto file = folder.write("scene.json", R"({ "format": "penumbra-scene/1",
  "size": [512, 512],
  "camera": {"eye": [0, 2, 6], "target": [0, 1, 0], "up": [0, 1, 0], "verticalFov": 45},
  "meshes": [
    {"name": "statue", "file": "statue.obj", "transform": {"translate": [0, 0, 0], "rotate": [0, 90, 0], "scale": 1}, "color": [0.8, 0.8, 0.8]},
    {"name": "bunny", "package": {"name": "glmark2-data", "file": "models/bunny.obj"}, "fit": {"height": 2, "base": [0, 0, 0]}},
    {"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [4, 0, 0], "halfV": [0, 0, -4]}, "color": [0.5, 0.5, 0.5]},
    {"name": "ball", "shape": {"type": "sphere", "center": [1, 1, 0], "radius": 0.5, "segments": 64}},
    {"name": "soup", "triangles": [[0,0,0, 1,0,0, 0,1,0]]}
  ],
  "lights": [
    {"name": "key", "rectangle": {"center": [0, 5, 0], "halfU": [0.5, 0, 0], "halfV": [0, 0, 0.5]}, "radiance": [10, 10, 10], "twoSided": false},
    {"name": "rim", "disk": {"center": [2, 5, 0], "normal": [0, -1, 0], "radius": 0.4}},
    {"name": "poly", "polygon": [[0,5,0],[1,5,0],[0,5,1]]},
    {"name": "bulb", "sphere": {"center": [0, 4, 2], "radius": 0.2}},
    {"name": "oval", "ellipse": {"center": [0, 5, 0], "halfU": [0.6, 0, 0], "halfV": [0, 0, 0.3]}},
    {"name": "sun", "sun": {"direction": [-0.35, -0.87, -0.35], "angle": 0.53}, "radiance": [60000, 58000, 50000]}
  ] })");
  const scenes::Scene scene = read_scene(file);
  ASSERT_EQ(scene.objects.size(), 5u);
  EXPECT_EQ(scene.name, "scene.json");
  EXPECT_EQ(scene.objects[1].name, "bunny");
  EXPECT_EQ(scene.objects[2].color, glm::dvec3(0.5));
  EXPECT_EQ(scene.soup.triangles.size(), 1u + 69'666 + 2 + 2 * 64 * 31 + 1);
  EXPECT_EQ(scene.soup.triangles.size(), scene.soup.object.size());
  EXPECT_EQ(scene.soup.triangles.size(), scene.soup.source_face.size());
  ASSERT_EQ(scene.lights.size(), 6u);
  EXPECT_TRUE(std::holds_alternative<scenes::Disk>(scene.lights[1].shape));
  EXPECT_EQ(scene.lights[2].radiance, glm::dvec3(10));
  EXPECT_EQ(std::get<scenes::Ellipse>(scene.lights[4].shape).half_v, glm::dvec3(0, 0, 0.3));
  const auto& sun = std::get<scenes::Sun>(scene.lights[5].shape);
  EXPECT_EQ(sun.angle, 0.53);
  EXPECT_NEAR(glm::length(sun.direction), 1, 1e-15);
  EXPECT_LT(glm::length(glm::cross(sun.direction, glm::dvec3(-0.35, -0.87, -0.35))), 1e-15);
  // A quarter turn about Y takes X to −Z, exactly.
  EXPECT_EQ(scene.soup.positions[1], glm::dvec3(0, 0, -1));
}

TEST(JsonScene, ASunsIrradianceIsThatOfWhatFacesIt) {
  const auto light = [](const char* angle, const char* what) {
    return read_text(
        scene_text(kMesh, fmt::format(R"({{"sun": {{"direction": [0,-2,0], "angle": {}}}, {}}})", angle, what)));
  };
  const scenes::Scene wide = light("60", R"("irradiance": [1, 2, 4])");  // π sin² 30° = π / 4
  EXPECT_NEAR(wide.lights[0].radiance.y * std::numbers::pi / 4, 2, 1e-15);
  EXPECT_EQ(std::get<scenes::Sun>(wide.lights[0].shape).direction, glm::dvec3(0, -1, 0));
  const scenes::Scene hard = light("0", R"("irradiance": [1, 2, 4])");
  EXPECT_EQ(hard.lights[0].radiance, glm::dvec3(1, 2, 4));
  EXPECT_TRUE(hard.warnings.empty());
  const scenes::Scene read_so = light("0", R"("radiance": [1, 2, 4])");
  EXPECT_EQ(read_so.lights[0].radiance, glm::dvec3(1, 2, 4));
  ASSERT_EQ(read_so.warnings.size(), 1u);
  EXPECT_NE(read_so.warnings[0].find("/lights/0/radiance: a sun of angle 0"), std::string::npos);
}

TEST(JsonScene, LinksLightsAndMeshes) {
  const auto scene = read_text(R"({"format": "penumbra-scene/1", "camera": {"eye": [0,2,6], "target": [0,0,0]},
    "meshes": [{"name": "floor", "shape": {"type": "box"}}, {"name": "glass", "shape": {"type": "box"}, "lights": ["b", "a", "b"]},
               {"name": "glass", "shape": {"type": "box"}, "lights": []}],
    "lights": [{"name": "a", "sphere": {"center": [0,5,0], "radius": 1}, "casters": {"exclude": ["glass"]}},
               {"name": "b", "sphere": {"center": [0,5,0], "radius": 1}, "casters": {"include": ["glass", "floor"], "exclude": ["floor"]}},
               {"name": "c", "sphere": {"center": [0,5,0], "radius": 1}, "casters": {"include": []}},
               {"name": "d", "sphere": {"center": [0,5,0], "radius": 1}}]})");
  using Numbers = std::vector<std::uint32_t>;
  EXPECT_FALSE(scene.objects[0].lit_by);
  EXPECT_EQ(scene.objects[1].lit_by, (Numbers{0, 1}));
  EXPECT_EQ(scene.objects[2].lit_by, Numbers{}) << "by none";
  EXPECT_EQ(scene.lights[0].unshaded_by, (Numbers{1, 2})) << "the name stands for all meshes that have it";
  EXPECT_EQ(scene.lights[1].unshaded_by, Numbers{0});
  EXPECT_EQ(scene.lights[2].unshaded_by, (Numbers{0, 1, 2}));
  EXPECT_TRUE(scene.lights[3].unshaded_by.empty());
}

TEST(JsonScene, RotatesAboutXThenYThenZThenTranslates) {
  // (0, 1, 0): scaled to (0, 2, 0); turned about X by 90 → (0, 0, 2), about Y by 90 → (2, 0, 0), about Z by 90 → (0, 2,
  // 0).
  const auto scene = read_text(scene_text(R"({"triangles": [[0,1,0, 1,0,0, 0,0,1]],
      "transform": {"scale": 2, "rotate": [90, 90, 90], "translate": [10, 20, 30]}})"));
  EXPECT_EQ(scene.soup.positions[0], glm::dvec3(10, 22, 30));
  // (1, 0, 0) → (2, 0, 0) → (0, 0, −2) → (0, 0, −2); (0, 0, 1) → (0, −2, 0) → (0, −2, 0) → (2, 0, 0).
  EXPECT_EQ(scene.soup.positions[1], glm::dvec3(10, 20, 28));
  EXPECT_EQ(scene.soup.positions[2], glm::dvec3(12, 20, 30));
}

TEST(JsonScene, MatrixIsRowMajorForColumnVectors) {
  const auto scene = read_text(scene_text(R"({"triangles": [[1,2,3, 1,0,0, 0,0,1]],
      "transform": [0,-1,0,10, 1,0,0,20, 0,0,2,30, 0,0,0,1]})"));
  EXPECT_EQ(scene.soup.positions[0], glm::dvec3(8, 21, 36));
}

TEST(JsonScene, MirrorKeepsNormalsOutward) {
  const auto scene =
      read_text(scene_text(R"({"triangles": [[0,0,0, 1,0,0, 0,1,0]], "transform": {"scale": [-1, 1, 1]}})"));
  EXPECT_EQ(scene.soup.triangles[0], (mesh::Triangle{0, 2, 1}));
}

TEST(JsonScene, FitGivesHeightAndBase) {
  const auto scene = read_text(scene_text(R"({"shape": {"type": "box", "center": [7, 7, 7], "halfSize": [1, 4, 2]},
      "fit": {"height": 2, "base": [1, 2, 3]}})"));
  EXPECT_EQ(scene.soup.positions.front(), glm::dvec3(0.75, 2, 2.5));
  EXPECT_EQ(scene.soup.positions.back(), glm::dvec3(1.25, 4, 3.5));
}

TEST(JsonScene, DefaultsAreTheContracts) {
  const auto scene =
      read_text(scene_text(R"({"shape": {"type": "box"}})", R"({"sphere": {"center": [0,5,0], "radius": 1}})"));
  EXPECT_EQ(scene.width, 512u);
  EXPECT_EQ(scene.height, 512u);
  EXPECT_EQ(scene.cameras[0].vertical_fov, 45);
  EXPECT_EQ(scene.cameras[0].up, glm::dvec3(0, 1, 0));
  EXPECT_TRUE(scene.objects[0].casts_shadow);
  EXPECT_TRUE(scene.objects[0].receives_shadow);
  EXPECT_FALSE(scene.objects[0].emits.has_value());
  EXPECT_FALSE(scene.lights[0].two_sided);
}

TEST(JsonScene, DegenerateTrianglesStay) {
  const auto scene = read_text(scene_text(R"({"triangles": [[0,0,0, 0,0,0, 0,0,0], [0,0,0, 1,0,0, 2,0,0],
      [0,0,0, 1,0,0, 0,1,0], [0,0,0, 1,0,0, 0,1,0]]})"));
  EXPECT_EQ(scene.soup.triangles.size(), 4u);
  EXPECT_EQ(scene.soup.source_face, (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

TEST(JsonScene, SkewedRectangleIsSaid) {
  const auto scene =
      read_text(scene_text(kMesh, R"({"rectangle": {"center": [0,5,0], "halfU": [1,0,0], "halfV": [1,0,1]}})"));
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("/lights/0/rectangle: halfU and halfV are not at right angles"), std::string::npos);
  const auto oval =
      read_text(scene_text(kMesh, R"({"ellipse": {"center": [0,5,0], "halfU": [1,0,0], "halfV": [1,0,1]}})"));
  ASSERT_EQ(oval.warnings.size(), 1u);
  EXPECT_NE(oval.warnings[0].find("/lights/0/ellipse: halfU and halfV are not at right angles"), std::string::npos);
}

/// --camera selects cameras by name.
TEST(JsonScene, CamerasOfOneNameGetNumbers) {
  const TemporaryFolder folder;
  const std::string one = R"({"name": "shot", "eye": [0, 2, 6], "target": [0, 1, 0]})";
  const std::string taken = R"({"name": "shot_2", "eye": [0, 2, 6], "target": [0, 1, 0]})";
  const auto file = folder.write(
      "scene.json", scene_text(kMesh, kLight, "\"cameras\": [" + one + ", " + taken + ", " + one + ", " + one + "]"));
  const scenes::Scene scene = read_scene(file);
  std::vector<std::string> names;
  for (const scenes::Camera& camera : scene.cameras) names.push_back(camera.name);
  EXPECT_EQ(names, (std::vector<std::string>{"shot", "shot_2", "shot_3", "shot_4"}));
  ASSERT_EQ(scene.warnings.size(), 2u);
  EXPECT_NE(scene.warnings[0].find("/cameras/2: the name \"shot\" is taken; the camera is called \"shot_3\""),
            std::string::npos)
      << scene.warnings[0];
}

}  // namespace
}  // namespace penumbra::test
