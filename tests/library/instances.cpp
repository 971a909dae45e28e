// SPDX-License-Identifier: Apache-2.0
// Instances in the library's scenes: the same numbers with copies and without, the same as the program's, and after
// changes.

#include "tests/cli/program.hpp"
#include "tests/library/picture_bytes.hpp"

#include <penumbra/penumbra.hpp>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace penumbra::tests {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// Returns all numbers of a picture with one light that must be exact; the last bit of exact areas' form factors need
/// not be.
std::string exact_bytes(const Picture& picture) {
  return bytes_of(picture.alpha()) + bytes_of(picture.positions()) + bytes_of(picture.normals()) +
         bytes_of(picture.depth()) + bytes_of(picture.ids()) + bytes_of(picture.visibility(0)) +
         bytes_of(picture.masks(0));
}

constexpr std::array<std::array<std::uint32_t, 3>, 4> kTentFaces = {{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};

std::vector<Vector> tent(double height) {
  return {{-0.3, 0, -0.2}, {0.3, 0, -0.3}, {0.35, 0, 0.3}, {-0.3, 0.1, 0.3}, {0.1, height, 0}};
}

/// Returns a matrix that turns about Y, mirrors if `i` is odd, and moves.
Matrix place(int i) {
  const int row = i / 4;
  const double turn = 0.7 * i, c = std::cos(turn), s = std::sin(turn), flip = i % 2 == 0 ? 1 : -1;
  return {flip * c, 0, s, 0.7 * (i % 4) - 1, 0, 1 + 0.1 * i, 0, 0.05, -flip * s, 0, c, 0.8 * row - 0.9, 0, 0, 0, 1};
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix all{};
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      for (std::size_t i = 0; i < 4; ++i) all[4 * row + column] += a[4 * row + i] * b[4 * i + column];
    }
  }
  return all;
}

constexpr std::array<std::array<std::uint32_t, 3>, 2> kTwo = {{{0, 1, 2}, {0, 2, 3}}};
constexpr int kTents = 9;

/// Returns tents on a floor, in front of a wall, under a lamp.
Scene camp(double height, int tents = kTents) {
  Scene scene;
  const std::array<Vector, 4> floor = {{{-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, {-3, 0, -3}}},
                              wall = {{{-2, 0, -2}, {2, 0, -2}, {2, 1, -2}, {-2, 1.5, -2}}};
  scene.add_mesh("floor", floor, kTwo);
  const MeshId mesh = scene.add_mesh("tent", tent(height), kTentFaces, {.color = {0.6, 0.5, 0.3}});
  scene.add_mesh("wall", wall, kTwo);
  for (int i = 0; i < tents; ++i) EXPECT_EQ(scene.add_instance(mesh, place(i)).number, static_cast<std::uint32_t>(i));
  scene.add_light("key", Disk{.center = {0.5, 3, 0.3}, .normal = {0, -1, 0.1}, .radius = 0.4}, {.radiance = {5, 6, 7}});
  scene.set_camera({.eye = {0.2, 2, 4}, .target = {0, 0.2, 0}, .vertical_fov = 45});
  return scene;
}

const RenderOptions kShared{.width = 40, .height = 50, .instances = "shared"};  // two bands of rows

RenderOptions with(const std::string& instances, const std::string& method = {}) {
  RenderOptions options = kShared;
  options.method = method;
  options.instances = instances;
  if (!method.empty()) options.light_samples = 32;
  return options;
}

class LibraryInstances : public ProgramTest {};

TEST_F(LibraryInstances, AreTheFilesAndTheirCopies) {
  const Scene scene = camp(0.8);
  EXPECT_EQ(scene.triangle_count(), 4U + 4 * kTents);
  EXPECT_EQ(scene.instance_count(scene.mesh("tent")), static_cast<std::size_t>(kTents));
  EXPECT_EQ(scene.instance_count(scene.mesh("wall")), 0U);
  nlohmann::json file = {
      {"format", "penumbra-scene/1"},
      {"camera", {{"eye", {0.2, 2, 4}}, {"target", {0, 0.2, 0}}, {"verticalFov", 45}}},
      {"lights",
       {{{"name", "key"},
         {"radiance", {5, 6, 7}},
         {"disk", {{"center", {0.5, 3, 0.3}}, {"normal", {0, -1, 0.1}}, {"radius", 0.4}}}}}},
      {"meshes",
       {{{"name", "floor"}, {"triangles", {{-3, 0, 3, 3, 0, 3, 3, 0, -3}, {-3, 0, 3, 3, 0, -3, -3, 0, -3}}}},
        {{"name", "tent"}, {"color", {0.6, 0.5, 0.3}}},
        {{"name", "wall"}, {"triangles", {{-2, 0, -2, 2, 0, -2, 2, 1, -2}, {-2, 0, -2, 2, 1, -2, -2, 1.5, -2}}}}}}};
  const std::vector<Vector> corners = tent(0.8);
  for (const auto& face : kTentFaces) {
    std::vector<double> triangle;
    for (const std::uint32_t corner : face)
      triangle.insert(triangle.end(), corners[corner].begin(), corners[corner].end());
    file["meshes"][1]["triangles"].push_back(triangle);
  }
  for (int i = 0; i < kTents; ++i) file["meshes"][1]["instances"].push_back(place(i));
  write("camp.json", file.dump());
  for (const char* method : {"", "edge-scatter", "view-sample"}) {
    SCOPED_TRACE(method);
    const std::string copies = exact_bytes(Renderer(scene).render(with("copies", method)));
    EXPECT_EQ(exact_bytes(Renderer(scene).render(with("shared", method))), copies);
    EXPECT_EQ(exact_bytes(Renderer(Scene::load(path("camp.json"))).render(with("shared", method))), copies);
    EXPECT_EQ(exact_bytes(Renderer(Scene::load(path("camp.json"))).render(with("copies", method))), copies);
  }
  // A saved scene reads back as the same, with its instances.
  EXPECT_THAT(scene.save(path("saved.json")), IsEmpty());
  const Scene saved = Scene::load(path("saved.json"));
  EXPECT_EQ(saved.instance_count(saved.mesh("tent")), static_cast<std::size_t>(kTents));
  EXPECT_EQ(exact_bytes(Renderer(saved).render(kShared)), exact_bytes(Renderer(scene).render(kShared)));
}

TEST_F(LibraryInstances, MoveAndLeaveTheMeshesTreesAlone) {
  Renderer renderer(camp(0.8));
  const MeshId mesh = renderer.scene().mesh("tent");
  const auto built = [](const Picture& picture) {
    return nlohmann::json::parse(picture.stats_json()).at("counters").at("meshTreesBuilt").get<int>();
  };
  const Picture first = renderer.render(kShared);
  EXPECT_EQ(built(first), 1);
  const Matrix there = product({1, 0, 0, 0.3, 0, 1, 0, 0.4, 0, 0, 1, 0.2, 0, 0, 0, 1}, place(4));
  renderer.scene().set_transform(InstanceId{mesh, 4}, there);
  const Picture moved = renderer.render(kShared);
  EXPECT_EQ(built(moved), 0);
  EXPECT_NE(exact_bytes(moved), exact_bytes(first));
  EXPECT_EQ(exact_bytes(Renderer(renderer.scene()).render(with("copies"))), exact_bytes(moved));
  EXPECT_EQ(exact_bytes(renderer.render(with("copies"))), exact_bytes(moved))
      << "copies and shared instances must give the same, also one after the other";
  EXPECT_EQ(exact_bytes(renderer.render(kShared)), exact_bytes(moved));
  renderer.scene().set_transform(InstanceId{mesh, 4}, place(4));
  EXPECT_EQ(exact_bytes(renderer.render(kShared)), exact_bytes(first)) << "the origin must not move with the instance";
  // Positions belong to the mesh, and so to all instances; only its tree is built again.
  renderer.scene().set_positions(mesh, tent(1.1));
  const Picture higher = renderer.render(kShared);
  EXPECT_EQ(built(higher), 1);
  EXPECT_EQ(exact_bytes(Renderer(renderer.scene()).render(with("copies"))), exact_bytes(higher));
}

TEST_F(LibraryInstances, ChangeTogether) {
  const std::string high = exact_bytes(Renderer(camp(1.1)).render(kShared));
  Scene scene = camp(0.8);
  const MeshId mesh = scene.mesh("tent");
  scene.set_mesh(mesh, tent(1.1), kTentFaces);
  EXPECT_EQ(scene.instance_count(mesh), static_cast<std::size_t>(kTents));
  EXPECT_EQ(exact_bytes(Renderer(scene).render(kShared)), high);
  scene.set_positions(mesh, tent(0.8));
  EXPECT_EQ(exact_bytes(Renderer(scene).render(kShared)), exact_bytes(Renderer(camp(0.8)).render(kShared)));
  // A matrix for the mesh moves all instances: exactly, with the numbers chosen, as if each had been moved.
  const Matrix up = {1, 0, 0, 0, 0, 1, 0, 0.25, 0, 0, 1, 0, 0, 0, 0, 1};
  Scene each = scene, all = scene;
  for (int i = 0; i < kTents; ++i)
    each.set_transform(InstanceId{mesh, static_cast<std::uint32_t>(i)}, product(up, place(i)));
  all.set_transform(mesh, up);
  EXPECT_EQ(exact_bytes(Renderer(all).render(kShared)), exact_bytes(Renderer(each).render(kShared)));
  all.add_instance(mesh, place(kTents));
  each.add_instance(mesh, product(up, place(kTents)));
  EXPECT_EQ(exact_bytes(Renderer(all).render(kShared)), exact_bytes(Renderer(each).render(kShared)));
}

TEST_F(LibraryInstances, RefuseWhatCannotBe) {
  Scene scene = camp(0.8);
  const std::string before = exact_bytes(Renderer(scene).render(kShared));
  const MeshId mesh = scene.mesh("tent");
  Matrix far = place(0), flat = place(0);
  far[3] = 1e300, flat[12] = 1;
  EXPECT_THROW(scene.add_instance(MeshId{7}, place(0)), UsageError);
  EXPECT_THROW(scene.add_instance(mesh, far), InputError);
  EXPECT_THROW(scene.add_instance(scene.mesh("wall"), flat), InputError);
  EXPECT_THROW(scene.set_transform(InstanceId{mesh, kTents}, place(0)), UsageError);
  EXPECT_THROW(scene.set_transform(InstanceId{mesh, 1}, far), InputError);
  EXPECT_THROW(scene.set_transform(mesh, far), InputError);
  EXPECT_THROW(scene.set_positions(mesh, std::vector<Vector>(4)), InputError);
  EXPECT_THROW(static_cast<void>(Renderer(scene).render(with("some"))), UsageError);
  EXPECT_THROW(static_cast<void>(Renderer(scene).render(with("shared", "vssm"))), UsageError);
  EXPECT_EQ(exact_bytes(Renderer(scene).render(kShared)), before);
  // Methods that need more than the triangles between p and the light get copies.
  EXPECT_NO_THROW(static_cast<void>(Renderer(scene).render(with("", "vssm"))));
  EXPECT_THAT(wedges_json(scene, {.light = "key"}), HasSubstr("key"));
}

}  // namespace
}  // namespace penumbra::tests
