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

/// What is written reads back: to the last bit from JSON, to single precision from GLB, triangle by triangle from OBJ.
namespace penumbra::test {
namespace {

using scenes::read_scene;
using scenes::Scene;
using scenes::write_scene;

/// Distinguishes −0 from 0.
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
  }
}

constexpr const char* kEverything = R"({ "format": "penumbra-scene/1", "size": [640, 360],
  "cameras": [{"name": "main", "eye": [0.1, 2, 6.3], "target": [0, 1, 0], "verticalFov": 37.7}, {"eye": [1, 2, 3], "target": [0, 0, 0], "up": [1, 0, 0.2], "shift": [0.3, -0.1]}],
  "meshes": [
    {"name": "a \"quoted\" näme", "shape": {"type": "blob", "subdivisions": 2}, "transform": {"rotate": [13, 29, 71], "scale": [1.1, 0.9, -0.7], "translate": [1e-9, 0.3, -1e5]}, "color": [0.1, 0.2, 0.3]},
    {"shape": {"type": "hair", "strands": 20}, "castsShadow": false},
    {"quad": {"center": [0, -0.0, 0], "halfU": [4, 0, 0], "halfV": [0, 0, -4]}, "receivesShadow": false, "lights": ["key", "sun"]},
    {"name": "lamp", "triangles": [[0,5,0, 1,5,0, 0,5,1]], "emits": "poly"}],
  "lights": [
    {"name": "key", "rectangle": {"center": [0, 5, 0], "halfU": [0.1, 0, 0], "halfV": [0, 0, 0.3]}, "radiance": [1.5, 0, 1e-7], "twoSided": true},
    {"name": "rim", "disk": {"center": [2, 5, 0], "normal": [0.3, -1, 0.1], "radius": 0.4}},
    {"name": "poly", "polygon": [[0,5,0],[1,5,0],[0,5,1]]},
    {"name": "oval", "ellipse": {"center": [0, 5, 0.1], "halfU": [0.6, 0, 0], "halfV": [0, 0.1, 0.3]}},
    {"name": "sun", "sun": {"direction": [-0.35, -0.87, -0.35], "angle": 0.53}, "irradiance": [3, 2.9, 2.5]},
    {"name": "point", "sun": {"direction": [0.1, -0.87, -0.35], "angle": 0}, "irradiance": [0.1, 0.2, 0.3]},
    {"name": "spot", "sphere": {"center": [0, 4, -2], "radius": 0.1, "cone": {"direction": [0.1, -1, 0.2], "inner": 10, "outer": 25, "smooth": true}}},
    {"name": "bulb", "sphere": {"center": [0, 4, 2], "radius": 0.2}, "casters": {"include": ["lamp", "a \"quoted\" näme"]}}] })";

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
  while (scene.soup.positions.size() < 3000) {  // random bits, whose magnitudes are all over the range
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
  EXPECT_NE(notes[0].find("of which OBJ says nothing"), std::string::npos);
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

/// The nearest float32, as a double.
glm::dvec3 rounded(const glm::dvec3& v) {
  return glm::dvec3(glm::vec3(v));
}

TEST(GlbWriter, ReadsBackInSinglePrecision) {
  const TemporaryFolder folder;
  const Scene scene = read_scene(std::filesystem::path(PENUMBRA_SCENES) / "fusion.json");
  EXPECT_TRUE(write_scene(scene, folder / "scene.glb").empty());
  const Scene again = read_scene(folder / "scene.glb");
  ASSERT_EQ(again.soup.triangles.size(), scene.soup.triangles.size()) << "a light without a body stays without";
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

TEST(GlbWriter, SaysWhatGltfCannotHold) {
  const TemporaryFolder folder;
  const char* const linked = "is lit by some lights alone, which glTF cannot say";
  const char* const shading = "'bulb' has shadows of some meshes alone, which glTF cannot say";
  for (const char* message : {linked, shading, "--lenient writes all the same"})
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

/// Names of lights are not those of their bodies.
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

/// The outline of a light without a body is no geometry, and a light that is dark leaves none.
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

/// Suns, spheres and spots are lamps of KHR_lights_punctual, with their sizes as extras.
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
}

/// Pictures, alpha, colours and normals, to the last bit where they are float32.
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
