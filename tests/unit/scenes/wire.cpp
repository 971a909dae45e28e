// SPDX-License-Identifier: Apache-2.0
// Tests the transfer of scenes from the import helper: every field arrives, and damaged messages are refused.
#include "mesh/import_wire.hpp"
#include "scenes/scene_wire.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <memory>

namespace penumbra::scenes {
namespace {

using mesh::WireError;
using mesh::WireReader;
using mesh::WireWriter;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Returns a scene with a different value in every transferred field.
Scene full_scene() {
  Scene scene;
  scene.name = "all of it";
  scene.width = 31, scene.height = 17;
  scene.soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  scene.soup.triangles = {{0, 1, 2}};
  scene.soup.object = {0};
  scene.soup.source_face = {7};
  scene.looks.normals = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}};
  scene.looks.colors = {{.1F, .2F, .3F, .4F}, {.5F, .6F, .7F, .8F}, {.9F, 1, 0, 1}};
  scene.looks.places = {{0, 0}, {1, 0}, {0, .5}};
  scene.objects = {{.name = "lamp",
                    .color = {.2, .3, .4},
                    .casts_shadow = false,
                    .receives_shadow = true,
                    .emits = 1,
                    .material = "glass",
                    .picture = PictureUse{0, PictureUse::Wrap::clamp, PictureUse::Wrap::mirror, true},
                    .alpha = {Alpha::Mode::blend, .75, .25}},
                   {.name = "plain", .receives_shadow = false, .emits = {}}};
  scene.pictures = {{"bark.png", 2, 1, {{1, 2, 3, 4}, {5, 6, 7, 8}}}};
  const Rectangle rectangle{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  const Polygon polygon{{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}};
  const Sphere spot{{3, 2, 1}, .5, Cone{{0, -1, 0}, 20, 40, true}};
  for (const LightShape& shape : std::initializer_list<LightShape>{
           rectangle, Disk{{1, 1, 1}, {0, 1, 0}, 2}, polygon, spot, Ellipse{{9, 8, 7}, {6, 5, 4}, {3, 2, 1}},
           Sun{{0, -1, 0}, .53}, Pieces{{polygon, rectangle, Sphere{{1, 0, 1}, .25}}}}) {
    scene.lights.push_back({.name = "light " + std::to_string(scene.lights.size()),
                            .shape = shape,
                            .radiance = {3, 2, 1},
                            .two_sided = scene.lights.empty(),
                            .unshaded_by = {0, 1}});
  }
  scene.cameras = {{"front", {1, 2, 3}, {4, 5, 6}, {0, 0, 1}, 33, 2.5, 1.5, {.1, .2}, ThinLens{.3, 4}},
                   {.name = "side"}};
  scene.origin = glm::dvec3(1, 2, 4);
  scene.motion = Motion{.5, 2};
  scene.warnings = {"one", "two"};
  return scene;
}

std::vector<std::byte> bytes_of(const Scene& scene) {
  WireWriter to;
  put_scene(to, scene);
  return to.bytes();
}

Scene scene_of(const std::vector<std::byte>& bytes) {
  WireReader from(bytes);
  Scene scene = get_scene(from);
  from.expect_end();
  return scene;
}

TEST(SceneWire, BringsInstancesWhoseNumbersAreInRange) {
  const Scene scene = full_scene();
  Instances sent;
  const SharedMesh mesh{.soup = scene.soup,
                        .normals = {{0, 0, 1}, {0, 1, 0}, {.3, .1, .2}},
                        .colors = {{.1F, .2F, .3F, .4F}, {0, 0, 0, 1}, {1, 1, 1, 1}},
                        .places = {{0, 1}, {2, 3}, {4, 5}}};
  sent.meshes.push_back(std::make_shared<const SharedMesh>(mesh));
  for (std::uint32_t i = 0; i < 3; ++i)
    sent.all.push_back({.object = i % 2, .placement = {glm::dmat4(i + .5), i == 1}, .soup_before = i / 2});
  const auto bytes_of_instances = [](const Instances& instances) {
    WireWriter to;
    put_instances(to, instances);
    return to.bytes();
  };
  const auto got = [&](const Instances& instances) {
    const std::vector<std::byte> bytes = bytes_of_instances(instances);
    WireReader from(bytes);
    return get_instances(from, scene);
  };
  EXPECT_EQ(bytes_of_instances(got(sent)), bytes_of_instances(sent));
  EXPECT_EQ(got(sent).all.at(2).soup_before, 1U);
  EXPECT_EQ(got(sent).all.at(1).placement.to_world, sent.all[1].placement.to_world);
  const auto refused = [&](auto change) {
    Instances changed = sent;
    change(changed);
    EXPECT_THROW(got(changed), WireError);
  };
  refused([](Instances& all) { all.all[0].mesh = 1; });
  refused([](Instances& all) { all.all[0].object = 2; });
  refused([](Instances& all) { all.all[2].soup_before = 2; });
  refused([](Instances& all) { all.all[1].soup_before = 1, all.all[2].soup_before = 0; });
  refused([](Instances& all) { all.all[0].placement.to_world[3][1] = kNan; });
  const auto refused_mesh = [&](auto change) {
    SharedMesh changed = mesh;
    change(changed);
    refused([&](Instances& all) { all.meshes[0] = std::make_shared<const SharedMesh>(changed); });
  };
  refused_mesh([](SharedMesh& all) { all.normals.pop_back(); });
  refused_mesh(
      [](SharedMesh& all) { all.soup.triangles.clear(), all.soup.object.clear(), all.soup.source_face.clear(); });
}

TEST(SceneWire, LosesNothing) {
  const Scene sent = full_scene();
  const Scene got = scene_of(bytes_of(sent));
  EXPECT_EQ(bytes_of(got), bytes_of(sent));
  EXPECT_EQ(got.name, sent.name);
  EXPECT_EQ(got.width, sent.width);
  EXPECT_EQ(got.height, sent.height);
  EXPECT_EQ(got.soup.source_face, sent.soup.source_face);
  EXPECT_EQ(got.looks.normals, sent.looks.normals);
  EXPECT_EQ(got.looks.colors, sent.looks.colors);
  EXPECT_EQ(got.looks.places, sent.looks.places);
  ASSERT_EQ(got.objects.size(), 2U);
  const Object& lamp = got.objects[0];
  EXPECT_EQ(lamp.name, "lamp");
  EXPECT_EQ(lamp.color, glm::dvec3(.2, .3, .4));
  EXPECT_FALSE(lamp.casts_shadow);
  EXPECT_TRUE(lamp.receives_shadow);
  EXPECT_EQ(lamp.emits, 1U);
  EXPECT_EQ(lamp.material, "glass");
  EXPECT_EQ(lamp.picture, sent.objects[0].picture);
  EXPECT_EQ(lamp.alpha, sent.objects[0].alpha);
  EXPECT_FALSE(got.objects[1].receives_shadow || got.objects[1].emits || got.objects[1].picture);
  EXPECT_EQ(got.pictures, sent.pictures);
  ASSERT_EQ(got.lights.size(), sent.lights.size());
  for (std::size_t i = 0; i < got.lights.size(); ++i) {
    const AreaLight &a = got.lights[i], &b = sent.lights[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.shape.index(), b.shape.index());
    EXPECT_EQ(a.radiance, b.radiance);
    EXPECT_EQ(a.two_sided, b.two_sided);
    EXPECT_EQ(a.unshaded_by, b.unshaded_by);
  }
  EXPECT_EQ(std::get<Rectangle>(got.lights[0].shape).half_v, glm::dvec3(7, 8, 9));
  EXPECT_EQ(std::get<Disk>(got.lights[1].shape).radius, 2);
  EXPECT_EQ(std::get<Polygon>(got.lights[2].shape).vertices.back(), glm::dvec3(0, 0, 1));
  const Sphere& spot = std::get<Sphere>(got.lights[3].shape);
  ASSERT_TRUE(spot.cone);
  EXPECT_TRUE(spot.radius == .5 && spot.cone->inner == 20 && spot.cone->outer == 40 && spot.cone->smooth);
  EXPECT_EQ(std::get<Ellipse>(got.lights[4].shape).half_u, glm::dvec3(6, 5, 4));
  EXPECT_EQ(std::get<Sun>(got.lights[5].shape).angle, .53);
  const Pieces& pieces = std::get<Pieces>(got.lights[6].shape);
  ASSERT_EQ(pieces.pieces.size(), 3U);
  EXPECT_EQ(std::get<Sphere>(pieces.pieces[2]).radius, .25);
  ASSERT_EQ(got.cameras.size(), 2U);
  const Camera& front = got.cameras[0];
  EXPECT_EQ(front.name, "front");
  EXPECT_TRUE(front.eye == glm::dvec3(1, 2, 3) && front.target == glm::dvec3(4, 5, 6));
  EXPECT_EQ(front.up, glm::dvec3(0, 0, 1));
  EXPECT_TRUE(front.vertical_fov == 33 && front.height == 2.5 && front.aspect == 1.5);
  EXPECT_EQ(front.shift, glm::dvec2(.1, .2));
  EXPECT_EQ(front.lens, (ThinLens{.3, 4}));
  EXPECT_FALSE(got.cameras[1].lens || got.cameras[1].height || got.cameras[1].aspect);
  EXPECT_EQ(got.origin, sent.origin);
  ASSERT_TRUE(got.motion);
  EXPECT_TRUE(got.motion->first == .5 && got.motion->last == 2);
  EXPECT_EQ(got.warnings, sent.warnings);
}

TEST(SceneWire, EveryAnswerThatEndsTooEarlyIsRefused) {
  const std::vector<std::byte> all = bytes_of(full_scene());
  for (std::size_t size = 0; size < all.size(); ++size) {
    const std::vector<std::byte> some(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_THROW(scene_of(some), WireError) << size << " of " << all.size() << " bytes";
  }
}

TEST(SceneWire, WhatNoSceneHasIsRefused) {
  const auto refuses = [](const char* what, auto change) {
    Scene scene = full_scene();
    change(scene);
    EXPECT_THROW(scene_of(bytes_of(scene)), WireError) << what;
  };
  refuses("a number", [](Scene& s) { s.cameras[0].vertical_fov = kNan; });
  refuses("a vector", [](Scene& s) { s.cameras[0].up.y = kNan; });
  refuses("a shift", [](Scene& s) { s.cameras[0].shift.y = kNan; });
  refuses("an optional number", [](Scene& s) { s.cameras[0].aspect = kNan; });
  refuses("a lens", [](Scene& s) { s.cameras[0].lens->focus_distance = kNan; });
  refuses("a corner", [](Scene& s) { std::get<Polygon>(s.lights[2].shape).vertices[1].z = kNan; });
  refuses("a cone", [](Scene& s) { std::get<Sphere>(s.lights[3].shape).cone->outer = kNan; });
  refuses("a place", [](Scene& s) { s.looks.places[2].x = kNan; });
  refuses("two corners", [](Scene& s) { std::get<Polygon>(s.lights[2].shape).vertices.pop_back(); });
  refuses("no pieces", [](Scene& s) { std::get<Pieces>(s.lights[6].shape).pieces.clear(); });
  refuses("texels", [](Scene& s) { s.pictures[0].width = 3; });
  refuses("normals", [](Scene& s) { s.looks.normals.pop_back(); });
  refuses("colours", [](Scene& s) { s.looks.colors.pop_back(); });
  refuses("places", [](Scene& s) { s.looks.places.pop_back(); });
  refuses("an object", [](Scene& s) { s.soup.object = {2}; });
  refuses("an emitter", [](Scene& s) { s.objects[0].emits = 7; });
  refuses("a picture", [](Scene& s) { s.objects[0].picture->picture = 1; });
  refuses("a caster", [](Scene& s) { s.lights[0].unshaded_by = {2}; });
  refuses("a way to wrap", [](Scene& s) { s.objects[0].picture->wrap_t = static_cast<PictureUse::Wrap>(3); });
  refuses("a mode", [](Scene& s) { s.objects[0].alpha.mode = static_cast<Alpha::Mode>(3); });
}

/// Returns the bytes of a message up to the shape of the scene's only light.
WireWriter up_to_shape() {
  WireWriter to;
  to.put_string("scene");
  to.put<std::uint32_t>(1), to.put<std::uint32_t>(1);
  static const mesh::TriangleSoup nothing;
  mesh::put_soup(to, nothing);
  for (int list = 0; list < 5; ++list) to.put<std::uint64_t>(0);  // looks, objects, pictures
  to.put<std::uint64_t>(1);
  to.put_string("light");
  return to;
}

// Nested pieces in a hostile answer must not exhaust the stack.
TEST(SceneWire, PiecesInPiecesAreRefused) {
  WireWriter to = up_to_shape();
  for (int depth = 0; depth < 1'000'000; ++depth) to.put<std::uint8_t>(6), to.put<std::uint64_t>(1);
  EXPECT_THROW(scene_of(to.bytes()), WireError);
}

TEST(SceneWire, CountsMakeNoRoom) {
  WireWriter to = up_to_shape();
  to.put<std::uint8_t>(6), to.put(std::numeric_limits<std::uint64_t>::max());
  EXPECT_THROW(scene_of(to.bytes()), WireError);
  to = up_to_shape();
  to.put<std::uint8_t>(2), to.put(std::numeric_limits<std::uint64_t>::max());
  EXPECT_THROW(scene_of(to.bytes()), WireError);
}

TEST(SceneWire, ShapesOfNoKindAreRefused) {
  WireWriter to = up_to_shape();
  to.put<std::uint8_t>(7);
  for (int i = 0; i < 20; ++i) to.put(1.0);
  EXPECT_THROW(scene_of(to.bytes()), WireError);
}

}  // namespace
}  // namespace penumbra::scenes
