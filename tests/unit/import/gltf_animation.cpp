// SPDX-License-Identifier: Apache-2.0
// Motion in glTF: animations, skins, morph targets.
#include "scenes/formats/gltf_reader.hpp"

#include "mesh/import_wire.hpp"
#include "scenes/formats/scenes_ahead.hpp"
#include "scenes/scene_wire.hpp"
#include "tests/unit/import/gltf_file.hpp"

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include <cmath>
#include <cstddef>
#include <set>
#include <vector>

namespace penumbra::scenes {
namespace {

using test::Gltf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class GltfAnimation : public test::FileTest {
 protected:
  Scene read(Gltf& gltf, std::optional<double> time = {}) const {
    ReadOptions options;
    options.time = time;
    return read_gltf(write("scene.glb", gltf.glb()), options);
  }
  std::string refusal(Gltf& gltf) const {
    const auto path = write("scene.glb", gltf.glb());
    ReadOptions options;
    options.time = 0.5;
    return test::input_error([&] { read_gltf(path, options); });
  }
  /// Returns the position of the body's corner that was modelled at (1, 0, 0).
  glm::dvec3 corner(Gltf& gltf, std::optional<double> time) const { return read(gltf, time).soup.positions[1]; }
};

constexpr float kHalf = 0.70710678f;  // sine and cosine of 45 degrees

TEST_F(GltfAnimation, RestsWhereNoTimeIsAsked) {
  Gltf gltf;
  gltf.animate(0, "translation", {1, 2}, {5, 0, 0, 7, 0, 0});
  EXPECT_EQ(corner(gltf, {}), glm::dvec3(1, 0, 0));
  const Scene scene = read(gltf);
  ASSERT_TRUE(scene.motion);
  EXPECT_EQ(scene.motion->first, 1);
  EXPECT_EQ(scene.motion->last, 2);
  EXPECT_THAT(scene.warnings, IsEmpty());
  Gltf still;
  EXPECT_FALSE(read(still, 1.0).motion);
}

TEST_F(GltfAnimation, LinearStepAndCubic) {
  Gltf linear;
  linear.animate(0, "translation", {1, 3}, {0, 0, 0, 8, 4, 0});
  EXPECT_EQ(corner(linear, 0), glm::dvec3(1, 0, 0));  // before the first key
  EXPECT_EQ(corner(linear, 1.5), glm::dvec3(3, 1, 0));
  EXPECT_EQ(corner(linear, 3), glm::dvec3(9, 4, 0));
  EXPECT_EQ(corner(linear, 99), glm::dvec3(9, 4, 0));
  Gltf step;
  step.animate(0, "scale", {1, 2, 3}, {1, 1, 1, 2, 2, 2, 5, 5, 5}, "STEP");
  EXPECT_EQ(corner(step, 1.99), glm::dvec3(1, 0, 0));
  EXPECT_EQ(corner(step, 2), glm::dvec3(2, 0, 0));
  EXPECT_EQ(corner(step, 3), glm::dvec3(5, 0, 0));
  // Values are in-tangent, value and out-tangent of two keys two seconds apart. Without slopes the curve is 3 t² − 2
  // t³; with the line's own slope it is the line; with a slope m only at the beginning, 2 m (t³ − 2 t² + t) is added.
  const auto cubic = [&](float out, float in, double time) {
    Gltf gltf;
    gltf.animate(0, "translation", {1, 3}, {0, 0, 0, 0, 0, 0, out, 0, 0, in, 0, 0, 8, 0, 0, 0, 0, 0}, "CUBICSPLINE");
    return corner(gltf, time).x - 1;
  };
  EXPECT_EQ(cubic(0, 0, 1.5), 8 * 0.15625);
  EXPECT_EQ(cubic(4, 4, 1.5), 2);
  EXPECT_EQ(cubic(1, 0, 1.5), 8 * 0.15625 + 2 * 0.140625);
  EXPECT_EQ(cubic(3, 3, 1), 0);
}

TEST_F(GltfAnimation, RotationsTakeTheShorterArc) {
  for (const float sign : {1.0f, -1.0f}) {  // a quaternion and its negative are one rotation
    Gltf gltf;
    gltf.animate(0, "rotation", {0, 3}, {0, 0, 0, 1, 0, sign * kHalf, 0, sign * kHalf});
    const glm::dvec3 turned = corner(gltf, 1);  // by 30 degrees about Y
    EXPECT_LT(glm::distance(turned, glm::dvec3(std::cos(M_PI / 6), 0, -std::sin(M_PI / 6))), 1e-7) << sign;
  }
}

TEST_F(GltfAnimation, LightsCamerasAndChildrenMove) {
  Gltf gltf;
  gltf.at("/nodes/1")["children"] = {2};
  gltf.at("/scenes/0/nodes") = {0, 1};
  gltf.animate(1, "translation", {0, 1}, {0, 5, 0, 0, 7, 0});
  const Scene scene = read(gltf, 0.5);
  EXPECT_EQ(std::get<Rectangle>(scene.lights[0].shape).center, glm::dvec3(0, 6, 0));
  EXPECT_EQ(scene.cameras[0].eye, glm::dvec3(1, 8, 8));
}

/// One parse gives the same scenes, to the last bit, as a parse for each; also if objects are scaled to zero or morph
/// targets are active at some times only.
TEST_F(GltfAnimation, ScenesReadAheadAreThoseReadAlone) {
  Gltf gltf;
  gltf.at("/meshes/0/primitives/0")["targets"] = {{{"POSITION", gltf.add_floats("VEC3", {0, 0, 0, 2, 0, 0, 0, 0, 0})}}};
  gltf.animate(0, "weights", {0, 1}, {0, 1});
  gltf.animate(0, "rotation", {0, 1}, {0, 0, 0, 1, 0, kHalf, 0, kHalf});
  gltf.animate(1, "scale", {0, 1, 2}, {1, 1, 1, 0, 0, 0, 1, 1, 1});
  const auto path = write("scene.glb", gltf.glb());
  const auto bytes = [](const Scene& scene) {
    mesh::WireWriter writer;
    put_scene(writer, scene);
    return writer.bytes();
  };
  const std::vector<double> times = {0.25, 1, 0.5, 1.75, 0.5};
  ScenesAhead ahead;
  ahead.times = times;
  ReadOptions options;
  options.needs_light = false;
  const auto read_at = [&](double time, ScenesAhead* from) {
    options.time = time;
    options.ahead = from;
    return read_gltf(path, options);
  };
  EXPECT_EQ(bytes(read_at(0, &ahead)), bytes(read_at(0, nullptr)));
  EXPECT_THAT(ahead.times, IsEmpty()) << "all times must be read together with the first";
  EXPECT_EQ(ahead.kept.size(), times.size());
  std::set<std::vector<std::byte>> different;
  for (const double time : times) {
    const std::vector<std::byte> one = bytes(read_at(time, &ahead));
    EXPECT_EQ(one, bytes(read_at(time, nullptr))) << time;
    different.insert(one);
  }
  EXPECT_EQ(different.size(), times.size() - 1) << "one time was requested twice";
  EXPECT_THAT(ahead.kept, IsEmpty());
  EXPECT_EQ(bytes(read_at(3, &ahead)), bytes(read_at(3, nullptr))) << "a time that is not in the list read ahead";

  Gltf still;
  const auto unmoved = write("still.glb", still.glb());
  ahead.times = times;
  options.time = 0;
  options.ahead = &ahead;
  read_gltf(unmoved, options);
  EXPECT_THAT(ahead.kept, IsEmpty()) << "a scene without animation is the same at all times";
}

/// World space is relative to the origin and must not jump: the origin is that of the scene at rest, whatever the time.
TEST_F(GltfAnimation, TheOriginRests) {
  Gltf gltf;
  gltf.animate(0, "translation", {0, 1}, {0, 0, 0, 100, 0, 0});
  const Scene at_rest = read(gltf);
  EXPECT_FALSE(at_rest.origin) << "no separate origin: it is the middle of the triangles";
  const glm::dvec3 middle(0, 2.5, 0);  // middle of the lamp from −1 to 1 at a height of 5, and of the body from 0 to 1
  for (const double time : {0.0, 0.25, 1.0}) EXPECT_EQ(read(gltf, time).origin, middle) << time;
  gltf.at("/meshes/0/primitives/0")["targets"] = {
      {{"POSITION", gltf.add_floats("VEC3", {0, 0, 0, 50, 0, 0, 0, 0, 0})}}};
  gltf.at("/meshes/0")["weights"] = {1};
  EXPECT_EQ(read(gltf).origin, middle);
}

TEST_F(GltfAnimation, MorphTargetsAreAddedByWeight) {
  Gltf gltf;
  const auto one = gltf.add_floats("VEC3", {0, 0, 0, 2, 0, 0, 0, 0, 0}),
             two = gltf.add_floats("VEC3", {0, 0, 0, 0, 4, 0, 0, 0, 0});
  gltf.at("/meshes/0/primitives/0")["targets"] = {{{"POSITION", one}}, {{"POSITION", two}}};
  EXPECT_EQ(corner(gltf, {}), glm::dvec3(1, 0, 0));
  gltf.at("/meshes/0")["weights"] = {0.5, 0.25};
  EXPECT_EQ(corner(gltf, {}), glm::dvec3(2, 1, 0));
  gltf.at("/nodes/0")["weights"] = {0, 1};
  EXPECT_EQ(corner(gltf, {}), glm::dvec3(1, 4, 0));
  gltf.animate(0, "weights", {0, 1}, {0, 0, 1, 1});
  EXPECT_EQ(corner(gltf, 0.5), glm::dvec3(2, 2, 0));
  EXPECT_THAT(read(gltf, 0.5).warnings, IsEmpty());
}

/// Two joints: node 3 stands still, node 4 moves. The body's corners follow node 3, node 4, and both.
Gltf skinned(const std::vector<float>& weights) {
  Gltf gltf;
  gltf.at("/nodes").push_back({{"name", "Hip"}});
  gltf.at("/nodes").push_back({{"name", "Knee"}, {"translation", {0, 0, 3}}});
  gltf.at("/scenes/0/nodes") = {0, 1, 2, 3, 4};
  std::vector<float> bind(32, 0);
  for (const std::size_t i : {0u, 5u, 10u, 15u, 16u, 21u, 26u, 31u}) bind[i] = 1;
  bind[16 + 14] = -3;  // the knee was bound at the place where it is
  gltf.document["skins"] = {{{"joints", {3, 4}}, {"inverseBindMatrices", gltf.add_floats("MAT4", bind)}}};
  gltf.at("/nodes/0")["skin"] = 0;
  auto& attributes = gltf.at("/meshes/0/primitives/0/attributes");
  attributes["JOINTS_0"] = gltf.add_floats("VEC4", {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
  attributes["WEIGHTS_0"] = gltf.add_floats("VEC4", weights);
  return gltf;
}

TEST_F(GltfAnimation, SkinsFollowTheirJointsAlone) {
  // The second corner follows the knee; the third follows it halfway, by weights that do not add up to 1.
  Gltf gltf = skinned({1, 0, 0, 0, 0, 1, 0, 0, 0.25f, 0.25f, 0, 0});
  gltf.at("/nodes/0")["translation"] = {50, 60, 70};  // a skin ignores the transform of the mesh's own node
  EXPECT_EQ(corner(gltf, {}), glm::dvec3(1, 0, 0)) << "at rest the skin must not move the corner";
  gltf.animate(4, "translation", {0, 1}, {0, 0, 3, 8, 0, 3});
  const Scene scene = read(gltf, 0.5);
  EXPECT_EQ(scene.soup.positions[0], glm::dvec3(0, 0, 0));
  EXPECT_EQ(scene.soup.positions[1], glm::dvec3(5, 0, 0));
  EXPECT_EQ(scene.soup.positions[2], glm::dvec3(2, 1, 0));
  EXPECT_THAT(scene.warnings, IsEmpty());
  // For the origin, a mesh at rest is where its node is, as if its skin did not bend it.
  EXPECT_EQ(scene.origin, glm::dvec3((51 - 1) / 2.0, (61 + 5) / 2.0, (70 + 1) / 2.0 - 1));
}

/// glTF 2.0, 3.7.3.1: without inverse bind matrices they are identities.
TEST_F(GltfAnimation, SkinsNeedNoBindMatrices) {
  Gltf gltf = skinned({1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
  gltf.at("/skins/0").erase("inverseBindMatrices");
  EXPECT_EQ(corner(gltf, {}), glm::dvec3(1, 0, 3)) << "the corner moves with the knee";
  EXPECT_THAT(read(gltf).warnings, IsEmpty());
}

/// The outline of a light without a body does not count for the origin, whether the file is read at a time or at rest.
TEST_F(GltfAnimation, OutlinesOfLightsMoveNoOrigin) {
  Gltf gltf;
  gltf.at("/nodes/1")["extras"] = {{"body", false}};
  gltf.animate(0, "translation", {0, 1}, {0, 0, 0, 4, 0, 0});
  const auto box_center = [](const Scene& scene) {
    glm::dvec3 lower = scene.soup.positions.front(), upper = lower;
    for (const glm::dvec3& p : scene.soup.positions) lower = glm::min(lower, p), upper = glm::max(upper, p);
    return 0.5 * lower + 0.5 * upper;
  };
  const Scene still = read(gltf, {});
  EXPECT_EQ(still.origin.value_or(box_center(still)), glm::dvec3(0.5, 0.5, 0));
  EXPECT_EQ(read(gltf, 1).origin, std::optional(glm::dvec3(0.5, 0.5, 0)));
}

/// A lamp is where its nodes' transforms put its node's origin, for any scales; animation of other nodes changes
/// nothing.
TEST_F(GltfAnimation, LampsUnderWhatIsScaledToNothingStay) {
  for (const bool animated : {false, true}) {
    Gltf gltf;
    gltf.document["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "point"}, {"intensity", 9}}}}}}};
    gltf.document["extensionsUsed"].push_back("KHR_lights_punctual");
    gltf.at("/nodes").push_back({{"name", "Arm"}, {"children", {4}}, {"translation", {1, 2, 3}}, {"scale", {1, 0, 1}}});
    gltf.at("/nodes").push_back(
        {{"name", "Bulb"}, {"translation", {0, 7, 1}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    gltf.at("/scenes/0/nodes") = {0, 1, 2, 3};
    if (animated) gltf.animate(0, "translation", {0, 1}, {0, 0, 0, 4, 0, 0});
    const Scene scene = read(gltf, animated ? std::optional(0.0) : std::nullopt);
    const auto bulb = std::ranges::find(scene.lights, "Bulb", &AreaLight::name);
    ASSERT_NE(bulb, scene.lights.end());
    EXPECT_EQ(std::get<Sphere>(bulb->shape).center, glm::dvec3(1, 2, 4)) << animated;
  }
}

/// A skinned lamp is where its joints are, and dark while they are scaled to zero.
TEST_F(GltfAnimation, ALampWhoseJointsAreScaledToNothingIsDark) {
  Gltf gltf = skinned({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  gltf.at("/meshes/0/primitives/0")["material"] = 1;
  gltf.at("/scenes/0/nodes").erase(1);  // the other lamp
  const Scene still = read(gltf, {});
  ASSERT_EQ(still.lights.size(), 1u);
  gltf.animate(3, "scale", {0, 1}, {1, 1, 1, 0, 0, 0}, "STEP");
  const Scene shown = read(gltf, 0), hidden = read(gltf, 1.5);
  ASSERT_EQ(shown.lights.size(), 1u);
  EXPECT_EQ(shown.lights[0].radiance, glm::dvec3(20, 10, 0));
  ASSERT_EQ(hidden.lights.size(), 1u);
  EXPECT_EQ(hidden.lights[0].radiance, glm::dvec3(0));
  EXPECT_EQ(std::get<Polygon>(hidden.lights[0].shape).vertices, std::get<Polygon>(shown.lights[0].shape).vertices);
  EXPECT_THAT(hidden.warnings, Contains(HasSubstr("'Body' is scaled to zero")));
  for (const glm::dvec3& p : hidden.soup.positions) EXPECT_EQ(p, hidden.soup.positions.front()) << "nothing is visible";
}

/// The usual way to hide a lamp: keys that set its scale to 0.
TEST_F(GltfAnimation, ALampThatIsScaledToNothingIsDark) {
  for (const bool by_parent : {false, true}) {
    Gltf gltf;
    gltf.at("/nodes").push_back({{"name", "Arm"}, {"children", {1}}});
    gltf.at("/scenes/0/nodes") = {0, 2, 3};
    gltf.at("/nodes/1")["scale"] = {2, 1, 1};
    if (by_parent)
      gltf.animate(3, "scale", {0, 1}, {1, 1, 1, 0, 0, 0}, "STEP");
    else
      gltf.animate(1, "scale", {0, 1}, {2, 1, 1, 0, 0, 0}, "STEP");
    gltf.animate(1, "translation", {0, 1, 2}, {0, 5, 0, 0, 5, 0, 0, 6, 0});
    const Scene shown = read(gltf, 0), hidden = read(gltf, 1.5);
    ASSERT_EQ(shown.lights.size(), 1u);
    ASSERT_EQ(hidden.lights.size(), 1u);
    EXPECT_EQ(hidden.lights[0].name, "Lamp");
    EXPECT_EQ(shown.lights[0].radiance, glm::dvec3(20, 10, 0));
    EXPECT_EQ(hidden.lights[0].radiance, glm::dvec3(0));
    const auto& before = std::get<Rectangle>(shown.lights[0].shape);
    const auto& after = std::get<Rectangle>(hidden.lights[0].shape);
    EXPECT_EQ(after.half_u, before.half_u) << "a hidden lamp keeps its shape at rest";
    EXPECT_EQ(after.half_v, before.half_v);
    EXPECT_EQ(after.center, glm::dvec3(0, 5.5, 0)) << "a hidden lamp is at its place at this time";
    EXPECT_THAT(shown.warnings, IsEmpty());
    EXPECT_THAT(hidden.warnings, ::testing::ElementsAre("'Lamp' is scaled to zero: its light is dark"));
    // The body is invisible, and still belongs to the light.
    ASSERT_EQ(hidden.objects.size(), shown.objects.size());
    EXPECT_EQ(hidden.objects[1].emits, std::optional(0u));
    for (const mesh::Triangle& t : hidden.soup.triangles) {
      if (hidden.soup.object[static_cast<std::size_t>(&t - hidden.soup.triangles.data())] != 1) continue;
      for (const std::uint32_t v : t) EXPECT_EQ(hidden.soup.positions[v], glm::dvec3(0, by_parent ? 0 : 5.5, 0));
    }
  }
  // A plane squashed along its normal keeps its area.
  Gltf flat;
  flat.animate(1, "scale", {0, 1}, {1, 1, 1, 1, 0, 1}, "STEP");
  EXPECT_EQ(read(flat, 2).lights[0].radiance, glm::dvec3(20, 10, 0));
  // A lamp of scale 0 at rest is as large as its mesh if it is animated; without any animation a scale of 0 is a
  // mistake.
  Gltf dark;
  dark.at("/nodes/1")["scale"] = {0, 0, 0};
  EXPECT_THAT(refusal(dark), HasSubstr("'Lamp' (it has no area)"));
  dark.animate(1, "scale", {0, 1}, {0, 0, 0, 3, 3, 3}, "STEP");
  EXPECT_EQ(glm::length(std::get<Rectangle>(read(dark, 0).lights[0].shape).half_u), 1);
  EXPECT_EQ(glm::length(std::get<Rectangle>(read(dark, 2).lights[0].shape).half_u), 3);
}

TEST_F(GltfAnimation, WhatGltfForbidsIsRefusedWithItsPlace) {
  const auto expect = [&](Gltf gltf, const std::string& what) { EXPECT_THAT(refusal(gltf), HasSubstr(what)); };
  Gltf gltf;
  gltf.animate(0, "translation", {2, 1}, {0, 0, 0, 8, 4, 0});
  expect(gltf, "times must ascend");
  EXPECT_THAT(read(gltf).warnings, Contains(HasSubstr("times must ascend")))
      << "at rest a faulty animation only causes a warning";
  gltf = {};
  gltf.animate(0, "translation", {1, 2}, {0, 0, 0});
  expect(gltf, "3 numbers for 2 keys; expected 6");
  gltf = {};
  gltf.animate(0, "translation", {1, 2}, {0, 0, 0, 0, 0, 0}, "QUADRATIC");
  expect(gltf, "expected LINEAR, STEP or CUBICSPLINE");
  gltf = {};
  gltf.animate(0, "rotation", {1, 2}, {0, 0, 0, 1, 0, 0, 0, 0});
  expect(gltf, "/animations/0/samplers/0/output: key 1 is a quaternion of length 0");
  gltf = {};
  gltf.animate(0, "weights", {1, 2}, {0, 0});
  expect(gltf, "/animations/0/channels/0/target/path: \"weights\" of node 0 cannot be moved");
  gltf = {};
  gltf.animate(77, "scale", {1, 2}, {1, 1, 1, 1, 1, 1});
  expect(gltf, "node 77 does not exist");
  gltf = {};
  gltf.animate(0, "scale", {1, 2}, {1, 1, 1, 1, 1, 1});
  gltf.at("/nodes/0")["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  expect(gltf, "node 0 has a matrix");
  gltf = skinned({1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
  gltf.at("/skins/0/joints") = {3, 44};
  expect(gltf, "/skins/0/joints/1: node 44 is not in the scene");
  gltf.at("/skins/0/joints") = {3};
  expect(gltf, "joint 1 of 1");
}

/// Two keys at one time are a jump: the later one holds from that time on.
TEST_F(GltfAnimation, JumpsAtTwoKeysOfOneTime) {
  Gltf gltf;
  gltf.animate(0, "translation", {0, 1, 1, 2}, {0, 0, 0, 1, 0, 0, 5, 0, 0, 7, 0, 0});
  EXPECT_EQ(corner(gltf, 0.5), glm::dvec3(1.5, 0, 0));
  EXPECT_EQ(corner(gltf, 1), glm::dvec3(6, 0, 0));
  EXPECT_EQ(corner(gltf, 1.5), glm::dvec3(7, 0, 0));
  Gltf first;
  first.animate(0, "translation", {1, 1}, {0, 0, 0, 8, 4, 0});
  EXPECT_EQ(corner(first, 0.5), glm::dvec3(1, 0, 0));
  EXPECT_EQ(corner(first, 1), glm::dvec3(9, 4, 0));
}

/// Exporters before Blender 3.2 wrote vertices without weights: they move with their node.
TEST_F(GltfAnimation, VerticesWithoutWeightsMoveWithTheirNode) {
  Gltf gltf = skinned({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0});
  gltf.at("/nodes/0")["translation"] = {0, 0, 9};
  const Scene scene = read(gltf, 0.5);
  EXPECT_EQ(scene.soup.positions[2], glm::dvec3(0, 1, 9));
  EXPECT_THAT(scene.warnings, Contains("'Body' has vertices that no joint moves; they move with their node"));
}

/// Only one of several clips that move the same objects is played: the first, or the requested one. A clip that moves
/// other objects is played, too.
TEST_F(GltfAnimation, OneOfSeveralClips) {
  Gltf gltf;
  gltf.animate(0, "translation", {0, 1}, {1, 0, 0, 1, 0, 0});
  gltf.animate(0, "translation", {0, 3}, {2, 0, 0, 2, 0, 0});
  gltf.animate(1, "translation", {0, 2}, {0, 7, 0, 0, 7, 0});
  gltf.at("/animations/0")["name"] = "Walk";
  gltf.at("/animations/1")["name"] = "Run";
  const auto lamp = [](const Scene& scene) { return std::get<Rectangle>(scene.lights[0].shape).center.y; };
  const Scene first = read(gltf, 0.5);
  EXPECT_EQ(first.soup.positions[1], glm::dvec3(2, 0, 0));
  EXPECT_EQ(lamp(first), 7);
  EXPECT_EQ(first.motion->last, 2);
  EXPECT_THAT(first.warnings, ::testing::ElementsAre("the clips 1 'Run' are not played, because they move the same "
                                                     "properties as 0 'Walk', 2 (choose with --clip)"));
  const auto path = write("clips.glb", gltf.glb());
  ReadOptions options;
  options.time = 0.5;
  for (const char* clip : {"Run", "1"}) {
    options.clips = {clip};
    const Scene scene = read_gltf(path, options);
    EXPECT_EQ(scene.soup.positions[1], glm::dvec3(3, 0, 0)) << clip;
    EXPECT_EQ(lamp(scene), 5) << "no other clip may be played";
    EXPECT_EQ(scene.motion->last, 3);
    EXPECT_THAT(scene.warnings, IsEmpty());
  }
  options.clips = {"Jump"};
  EXPECT_THAT(test::input_error([&] { read_gltf(path, options); }),
              HasSubstr("no animation clip \"Jump\"; there are 0 'Walk', 1 'Run', 2"));
  ReadOptions looked_at;
  looked_at.needs_light = false;
  EXPECT_THAT(read_gltf(path, looked_at).warnings, Contains(HasSubstr("clips are 0 'Walk', 1 'Run', 2")));
}

/// glTF 2.0, 3.11: a channel without a node is ignored. KHR_animation_pointer may name a node's own transform.
TEST_F(GltfAnimation, ChannelsWithoutANode) {
  const auto pointing_to = [](const std::string& pointer) {
    Gltf gltf;
    gltf.animate(0, "translation", {0, 1}, {4, 0, 0, 4, 0, 0});
    gltf.at("/animations/0/channels/0/target") = {{"path", "pointer"},
                                                  {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
    gltf.document["extensionsUsed"].push_back("KHR_animation_pointer");
    return gltf;
  };
  Gltf moved = pointing_to("/nodes/0/translation");
  EXPECT_EQ(corner(moved, 0.5), glm::dvec3(5, 0, 0));
  Gltf other = pointing_to("/materials/1/emissiveFactor");
  EXPECT_THAT(refusal(other), HasSubstr("'/materials/1/emissiveFactor' is animated by KHR_animation_pointer"));
  EXPECT_THAT(read(other).warnings, Contains(HasSubstr("'/materials/1/emissiveFactor'")))
      << "at rest the pointer only causes a warning";
  Gltf rough = pointing_to("/materials/0/pbrMetallicRoughness/roughnessFactor");
  EXPECT_THAT(read(rough, 0.5).warnings, Contains(HasSubstr("roughnessFactor")))
      << "roughness changes no shadow, so the pointer only causes a warning";
  other.animate(0, "translation", {0, 1}, {4, 0, 0, 4, 0, 0});
  ReadOptions second;
  second.time = 0.5;
  second.clips = {"1"};
  EXPECT_EQ(read_gltf(write("scene.glb", other.glb()), second).soup.positions[1], glm::dvec3(5, 0, 0))
      << "a clip that is not played must move nothing";
  Gltf without;
  without.animate(0, "translation", {0, 1}, {4, 0, 0, 4, 0, 0});
  without.at("/animations/0/channels/0/target").erase("node");
  const Scene scene = read(without, 0.5);
  EXPECT_EQ(scene.soup.positions[1], glm::dvec3(1, 0, 0));
  EXPECT_FALSE(scene.motion);
  EXPECT_THAT(scene.warnings, Contains("1 animation channels name no node and are ignored"));
}

}  // namespace
}  // namespace penumbra::scenes
