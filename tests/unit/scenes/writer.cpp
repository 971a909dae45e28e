// SPDX-License-Identifier: Apache-2.0
#include "scenes/formats/writer.hpp"
#include "tests/unit/scenes/support.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <variant>

/// Tests that written scenes read back: to the last bit from JSON, triangle by triangle from OBJ. For GLB see
/// writer_glb.cpp.
namespace penumbra::test {
namespace {

using scenes::read_scene;
using scenes::Scene;
using scenes::write_scene;

/// Returns whether the bits are equal: distinguishes −0 from 0.
bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
bool same_bits(const glm::dvec3& a, const glm::dvec3& b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}

void expect_same_shape(const scenes::AreaLight& a, const scenes::AreaLight& b) {
  ASSERT_EQ(a.shape.index(), b.shape.index());
  if (const auto* r = std::get_if<scenes::Rectangle>(&a.shape)) {
    const auto& s = std::get<scenes::Rectangle>(b.shape);
    EXPECT_TRUE(same_bits(r->center, s.center) && same_bits(r->half_u, s.half_u) && same_bits(r->half_v, s.half_v));
  } else if (const auto* d = std::get_if<scenes::Disk>(&a.shape)) {
    const auto& c = std::get<scenes::Disk>(b.shape);
    EXPECT_TRUE(same_bits(d->center, c.center) && same_bits(d->normal, c.normal) && same_bits(d->radius, c.radius));
  } else if (const auto* p = std::get_if<scenes::Polygon>(&a.shape)) {
    const auto& q = std::get<scenes::Polygon>(b.shape);
    ASSERT_EQ(p->vertices.size(), q.vertices.size());
    for (std::size_t i = 0; i < p->vertices.size(); ++i) EXPECT_TRUE(same_bits(p->vertices[i], q.vertices[i]));
  } else if (const auto* e = std::get_if<scenes::Ellipse>(&a.shape)) {
    const auto& f = std::get<scenes::Ellipse>(b.shape);
    EXPECT_TRUE(same_bits(e->center, f.center) && same_bits(e->half_u, f.half_u) && same_bits(e->half_v, f.half_v));
  } else if (const auto* u = std::get_if<scenes::Sun>(&a.shape)) {
    const auto& v = std::get<scenes::Sun>(b.shape);
    EXPECT_TRUE(same_bits(u->direction, v.direction) && same_bits(u->angle, v.angle));
  } else {
    const auto &s = std::get<scenes::Sphere>(a.shape), &t = std::get<scenes::Sphere>(b.shape);
    EXPECT_TRUE(same_bits(s.center, t.center) && same_bits(s.radius, t.radius));
    ASSERT_EQ(s.cone.has_value(), t.cone.has_value());
    if (s.cone) {
      EXPECT_TRUE(same_bits(s.cone->direction, t.cone->direction) && same_bits(s.cone->inner, t.cone->inner) &&
                  same_bits(s.cone->outer, t.cone->outer) && s.cone->smooth == t.cone->smooth);
    }
  }
}

void expect_same(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  ASSERT_EQ(a.soup.triangles.size(), b.soup.triangles.size());
  EXPECT_EQ(a.soup.object, b.soup.object);
  std::size_t differing = 0;
  for (std::size_t i = 0; i < a.soup.triangles.size(); ++i) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      differing +=
          !same_bits(a.soup.positions[a.soup.triangles[i][corner]], b.soup.positions[b.soup.triangles[i][corner]]);
    }
  }
  EXPECT_EQ(differing, 0u);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    EXPECT_EQ(a.objects[i].name, b.objects[i].name);
    EXPECT_TRUE(same_bits(a.objects[i].color, b.objects[i].color));
    EXPECT_EQ(a.objects[i].casts_shadow, b.objects[i].casts_shadow);
    EXPECT_EQ(a.objects[i].receives_shadow, b.objects[i].receives_shadow);
    EXPECT_EQ(a.objects[i].emits, b.objects[i].emits);
    EXPECT_EQ(a.objects[i].lit_by, b.objects[i].lit_by);
  }
  ASSERT_EQ(a.lights.size(), b.lights.size());
  for (std::size_t i = 0; i < a.lights.size(); ++i) {
    EXPECT_EQ(a.lights[i].name, b.lights[i].name);
    EXPECT_EQ(a.lights[i].two_sided, b.lights[i].two_sided);
    EXPECT_EQ(a.lights[i].unshaded_by, b.lights[i].unshaded_by);
    EXPECT_TRUE(same_bits(a.lights[i].radiance, b.lights[i].radiance));
    expect_same_shape(a.lights[i], b.lights[i]);
  }
  ASSERT_EQ(a.cameras.size(), b.cameras.size());
  for (std::size_t i = 0; i < a.cameras.size(); ++i) {
    EXPECT_EQ(a.cameras[i].name, b.cameras[i].name);
    EXPECT_TRUE(same_bits(a.cameras[i].eye, b.cameras[i].eye) && same_bits(a.cameras[i].target, b.cameras[i].target));
    EXPECT_TRUE(same_bits(a.cameras[i].up, b.cameras[i].up));
    EXPECT_TRUE(same_bits(a.cameras[i].vertical_fov, b.cameras[i].vertical_fov));
    EXPECT_EQ(a.cameras[i].shift, b.cameras[i].shift);
    EXPECT_EQ(a.cameras[i].lens, b.cameras[i].lens);
  }
}

TEST(JsonWriter, RoundTripIsBitExact) {
  const TemporaryFolder folder;
  const Scene scene = read_text(kEverything);
  EXPECT_TRUE(write_scene(scene, folder / "again.json").empty());
  const Scene again = read_scene(folder / "again.json");
  expect_same(scene, again);
  write_scene(again, folder / "third.json");
  EXPECT_EQ(read_file(folder / "again.json"), read_file(folder / "third.json"));
}

TEST(JsonWriter, ShippedScenesRoundTrip) {
  for (const char* name : {"bunny.json", "contact.json", "room.json", "thin.json"}) {
    const TemporaryFolder folder;
    const Scene scene = read_scene(std::filesystem::path(PENUMBRA_SCENES) / name);
    write_scene(scene, folder / name);
    expect_same(scene, read_scene(folder / name));
  }
}

TEST(JsonWriter, AnyFiniteDoubleSurvives) {
  constexpr std::uint64_t kSeed = 20240611;
  std::mt19937_64 random(kSeed);
  Scene scene = read_text(scene_text());
  scene.soup.positions = {
      {-0.0, 0.0, 5e-324}, {1e12, -1e12, 1 / 3.0}, {9007199254740993.0 / 65536, 0.1, 123456789012.0}};
  scene.soup.triangles = {{0, 1, 2}};
  while (scene.soup.positions.size() < 3000) {  // random bits, so that magnitudes cover the whole range
    glm::dvec3 position;
    for (int axis = 0; axis < 3; ++axis) {
      do {
        position[axis] = std::bit_cast<double>(static_cast<std::uint64_t>(random()));
      } while (!(std::abs(position[axis]) <= 1e12));
    }
    scene.soup.positions.push_back(position);
  }
  for (std::uint32_t i = 3; i + 2 < scene.soup.positions.size(); i += 3)
    scene.soup.triangles.push_back({i, i + 1, i + 2});
  scene.soup.object.assign(scene.soup.triangles.size(), 0);
  scene.soup.source_face.assign(scene.soup.triangles.size(), 0);
  const TemporaryFolder folder;
  write_scene(scene, folder / "scene.json");
  expect_same(scene, read_scene(folder / "scene.json"));
}

TEST(ObjWriter, TrianglesInOrderUnderTheirObjects) {
  const TemporaryFolder folder;
  const Scene scene = read_text(kEverything);
  const auto notes = write_scene(scene, folder / "scene.obj");
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_NE(notes[0].find("which OBJ cannot express"), std::string::npos);
  EXPECT_NE(notes[1].find("OBJ holds no lights and cameras; left out: 8 and 2"), std::string::npos);
  std::istringstream lines(read_file(folder / "scene.obj"));
  std::vector<glm::dvec3> positions;
  std::vector<std::string> objects;
  std::size_t triangle = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(2));
    if (line.starts_with("v ")) {
      std::string x, y, z;
      words >> x >> y >> z;
      positions.emplace_back(std::strtod(x.c_str(), nullptr), std::strtod(y.c_str(), nullptr),
                             std::strtod(z.c_str(), nullptr));
    } else if (line.starts_with("o ")) {
      objects.push_back(line.substr(2));
    } else if (line.starts_with("f ")) {
      ASSERT_LT(triangle, scene.soup.triangles.size());
      for (const std::uint32_t vertex : scene.soup.triangles[triangle]) {
        std::size_t number = 0;
        words >> number;
        EXPECT_TRUE(same_bits(positions.at(number - 1), scene.soup.positions[vertex]));
      }
      EXPECT_EQ(objects.size(), scene.soup.object[triangle] + 1);
      ++triangle;
    }
  }
  EXPECT_EQ(triangle, scene.soup.triangles.size());
  ASSERT_EQ(objects.size(), 4u);
  EXPECT_EQ(objects[0], "a \"quoted\" näme");
}

TEST(Writer, KeepsCamerasShapesAndSaysWhatIsLost) {
  const TemporaryFolder folder;
  Scene scene = read_text(scene_text());
  scene.width = scene.height = 512;
  scene.cameras.front().aspect = 2;
  EXPECT_TRUE(write_scene(scene, folder / "scene.json").empty());
  const Scene json = read_scene(folder / "scene.json");
  EXPECT_EQ(json.width, 512u);
  EXPECT_EQ(json.height, 256u);
  write_scene(scene, folder / "scene.glb");
  EXPECT_NEAR(read_scene(folder / "scene.glb").cameras.front().aspect.value(), 2, 1e-12);

  scenes::Camera upright = scene.cameras.front();
  upright.name = "upright";
  upright.aspect = 0.5;
  scene.cameras.push_back(upright);
  scene.motion = scenes::Motion{1, 3};
  scene.looks.normals.assign(scene.soup.positions.size(), glm::vec3(0, 1, 0));
  const auto notes = write_scene(scene, folder / "scene.json");
  ASSERT_EQ(notes.size(), 3u);
  EXPECT_NE(notes[0].find("normals of vertices"), std::string::npos);
  EXPECT_NE(notes[1].find("camera \"upright\""), std::string::npos);
  EXPECT_NE(notes[1].find("256x512"), std::string::npos);
  EXPECT_NE(notes[2].find("animation from 1 s to 3 s"), std::string::npos);
}

TEST(Writer, RefusesOtherFormatsAndLeavesNothingBehind) {
  const TemporaryFolder folder;
  const Scene scene = read_text(scene_text());
  expect_error(ExitCode::usage, "a scene is written as .json, .glb or .obj",
               [&] { write_scene(scene, folder / "scene.fbx"); });
  for (const char* name : {"scene.json", "scene.glb", "scene.obj"}) {
    ::setenv("PENUMBRA_TEST_DISK_QUOTA", "64", 1);
    expect_error(ExitCode::resource, "No space left on device", [&] { write_scene(scene, folder / name); });
    ::unsetenv("PENUMBRA_TEST_DISK_QUOTA");
  }
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace penumbra::test
