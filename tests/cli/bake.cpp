// SPDX-License-Identifier: Apache-2.0
// Tests bake: V and irradiance at texels and vertices, against closed forms and against a render of the same points.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"
#include "tests/unit/import/gltf_file.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr double kBakeRadiance = 10;

/// A floor of 8 x 8 at y = 0, a square light of side 2 at y = 5 that faces it, and optionally a tilted card in between.
json baked_floor(bool with_card) {
  json scene = json::parse(R"({"format": "penumbra-scene/1", "size": [16, 16],
    "camera": {"eye": [0, 4, 0], "target": [0, 0, 0], "up": [0, 0, -1], "orthographicHeight": 8},
    "meshes": [{"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [4, 0, 0], "halfV": [0, 0, -4]},
                "color": [0.5, 0.25, 0.125]}],
    "lights": [{"name": "key", "rectangle": {"center": [0, 5, 0], "halfU": [1, 0, 0], "halfV": [0, 0, 1]},
                "radiance": [10, 10, 10]}]})");
  if (with_card)
    scene["meshes"].push_back(json::parse(
        R"({"name": "card", "triangles": [[-1,4.2,-1, 1.3,4.4,-1, 1.1,4.6,1.2], [-1,4.2,-1, 1.1,4.6,1.2, -1,4.5,1]]})"));
  return scene;
}

/// Returns, for a point on the floor, the integral of both cosines over π d² for a rectangle of x by z at height h, one
/// corner of which is above the point (the form factor of a differential area and a parallel rectangle).
double corner_form_factor(double x, double z, double h) {
  const double a = x / h, b = z / h, c = std::sqrt(1 + a * a), d = std::sqrt(1 + b * b);
  return (a / c * std::atan(b / c) + b / d * std::atan(a / d)) / (2 * std::numbers::pi);
}
double baked_irradiance(double x, double z) {
  const auto corner = [&](double u, double w) { return corner_form_factor(u - x, w - z, 5); };
  return std::numbers::pi * kBakeRadiance * (corner(1, 1) - corner(-1, 1) - corner(1, -1) + corner(-1, -1));
}

class Bake : public ProgramTest {
 protected:
  ExrFile bake(std::vector<std::string> more) const {
    std::vector<std::string> all = {"bake", path("scene.json"), "--mesh", "floor", "--size", "16",
                                    "-o",   path("map.exr"),    "--quiet"};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = run(all);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return read_exr(path("map.exr"));
  }
};

TEST_F(Bake, AnOpenFloorHasTheClosedForm) {
  write("scene.json", baked_floor(false).dump());
  const ExrFile map = bake({});
  ASSERT_EQ(map.width, 16u);
  ASSERT_EQ(map.height, 16u);
  for (std::size_t i = 0; i < 256; ++i) {
    const double x = -4 + 8 * (static_cast<double>(i % 16) + 0.5) / 16,
                 z = -4 + 8 * (static_cast<double>(i / 16) + 0.5) / 16;
    EXPECT_EQ(map.floats.at("P.X")[i], x);
    EXPECT_EQ(map.floats.at("P.Z")[i], z);
    EXPECT_EQ(map.floats.at("V")[i], 1);
    EXPECT_EQ(map.floats.at("A")[i], 1);
    for (const char* channel : {"R", "G", "B", "key.R"})
      EXPECT_NEAR(map.floats.at(channel)[i], baked_irradiance(x, z), 1e-5 * baked_irradiance(x, z))
          << channel << ' ' << i;
  }
  EXPECT_THAT(map.attributes.at("penumbra.bake"), HasSubstr("floor"));
  const ExrFile back = bake({"--side", "back"});
  for (std::size_t i = 0; i < 256; ++i) {
    EXPECT_EQ(back.floats.at("V")[i], 0) << "the floor is between";
    EXPECT_EQ(back.floats.at("R")[i], 0);
    EXPECT_EQ(back.floats.at("N.Y")[i], -1);
  }
}

/// The camera looks straight down, so that pixels are texels, from between card and floor, so that the whole floor is
/// visible.
TEST_F(Bake, TexelsHaveTheVOfPixelsThatSeeTheSamePoints) {
  write("scene.json", baked_floor(true).dump());
  const std::vector<std::vector<std::string>> directions = {{},
                                                            {"--method", "exact"},
                                                            {"--light-samples", "64"},
                                                            {"--method", "view-sample", "--light-samples", "64"},
                                                            {"--method", "depth-complexity", "--light-samples", "64"},
                                                            {"--method", "soft-volume"},
                                                            {"--method", "hard-volume"},
                                                            {"--method", "shadow-map:size=256"},
                                                            {"--method", "pcss:size=256"},
                                                            {"--method", "raytrace", "--light-samples", "64"}};
  for (const auto& direction : directions) {
    SCOPED_TRACE(testing::PrintToString(direction));
    std::vector<std::string> render = {"render", path("scene.json"), "-o", path("seen.exr"), "--quiet"};
    render.insert(render.end(), direction.begin(), direction.end());
    const bool needs_perspective = !direction.empty() && direction.back().ends_with("-volume");
    const ExrFile map = bake(direction);
    if (needs_perspective) {  // refuses an orthographic camera: exact areas judge instead
      std::size_t near = 0;
      const ExrFile exact = bake({});
      for (std::size_t i = 0; i < 256; ++i)
        near += std::abs(map.floats.at("V")[i] - exact.floats.at("V")[i]) < 0.5 ? 1 : 0;
      EXPECT_GT(near, 240u);
      continue;
    }
    const Outcome outcome = run(render);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const ExrFile seen = read_exr(path("seen.exr"));
    EXPECT_EQ(map.floats.at("P.X"), seen.floats.at("P.X"));
    EXPECT_EQ(map.floats.at("P.Z"), seen.floats.at("P.Z"));
    const bool fits_map_to_view = !direction.empty() && direction.back().ends_with("=256");
    std::size_t differing = 0, shadowed = 0;
    for (std::size_t i = 0; i < 256; ++i) {
      differing += map.floats.at("V")[i] != seen.floats.at("V")[i] ? 1 : 0;
      shadowed += map.floats.at("V")[i] < 1 ? 1 : 0;
      // A picture shows the floor's colour times irradiance over π.
      const double beauty = 0.5 * double{map.floats.at("R")[i]} / std::numbers::pi;
      if (!fits_map_to_view) {
        EXPECT_NEAR(seen.floats.at("R")[i], beauty, 1e-5 * beauty + 1e-7) << i;
      }
    }
    EXPECT_GT(shadowed, 20u);
    EXPECT_EQ(differing, 0u);
  }
}

/// Returns the form factor of a rectangle that stands on the plane of a differential area at `distance`: its base
/// begins at the point nearest to the area and extends along z to `width`. Odd in `width`.
double standing_form_factor(double distance, double width, double height) {
  const double slant = std::hypot(distance, height);
  return (std::atan(width / distance) - distance / slant * std::atan(width / slant)) / (2 * std::numbers::pi);
}

/// A wall stands on the floor, from z = -2 to 2.5 and 3 high, under half a dome. Exact areas must be the closed form;
/// counted directions must give the V of pixels that see the same points.
TEST_F(Bake, UnderADomeAWallHidesItsFormFactor) {
  json scene = baked_floor(false);
  scene["meshes"].push_back(json::parse(
      R"({"name": "wall", "quad": {"center": [3, 1.5, 0.25], "halfU": [0, 0, 2.25], "halfV": [0, 1.5, 0]}})"));
  for (const bool sampled : {false, true}) {
    scene["lights"] = {{{"name", "sky"}, {"dome", {{"half", true}, {"sampled", sampled}}}, {"radiance", {2, 2, 2}}}};
    write("scene.json", scene.dump());
    const ExrFile map = bake({});
    ASSERT_EQ(run({"render", path("scene.json"), "-o", path("seen.exr"), "--quiet"}).code, 0);
    const ExrFile seen = read_exr(path("seen.exr"));
    double farthest = 0;
    for (std::size_t i = 0; i < 256; ++i) {
      const double x = -4 + 8 * (static_cast<double>(i % 16) + 0.5) / 16,
                   z = -4 + 8 * (static_cast<double>(i / 16) + 0.5) / 16, distance = std::abs(x - 3);
      EXPECT_EQ(map.floats.at("V")[i], seen.floats.at("V")[i]) << i;
      const double hidden = standing_form_factor(distance, 2.5 - z, 3) - standing_form_factor(distance, -2 - z, 3);
      const double off = std::abs(double{map.floats.at("V")[i]} - (1 - hidden));
      farthest = std::max(farthest, off);
      if (sampled) continue;
      EXPECT_LT(off, 1e-5) << x << ' ' << z;
      EXPECT_NEAR(map.floats.at("G")[i], 2 * std::numbers::pi * (1 - hidden), 1e-5 * 2 * std::numbers::pi);
    }
    EXPECT_EQ(farthest > 1e-4, sampled) << "256 directions are no closed form";
  }
}

/// A mesh with instances is baked where it stands, and instances cast the same shadows as copies.
TEST_F(Bake, AnInstancedMeshIsBakedWhereItStands) {
  json scene = baked_floor(true);
  json card = scene["meshes"][1];
  scene["meshes"][1]["instances"] =
      json::parse(R"([{"translate": [-2, 0, 0]}, {"translate": [1, -0.5, 1], "rotate": [0, 40, 0]}])");
  write("scene.json", scene.dump());
  const ExrFile shared = bake({});
  json copies = baked_floor(false);
  for (const json& place : scene["meshes"][1]["instances"]) {
    copies["meshes"].push_back(card);
    copies["meshes"].back()["transform"] = place;
  }
  write("scene.json", copies.dump());
  EXPECT_EQ(bake({}).floats, shared.floats);
  EXPECT_GT(std::ranges::count_if(shared.floats.at("V"), [](float v) { return v > 0 && v < 1; }), 40);

  // Several instances of the floor share one map, that of the first; a warning counts the others.
  scene["meshes"][0]["instances"] = json::parse(R"([{}, {"translate": [0, -3, 0]}])");
  write("scene.json", scene.dump());
  const ExrFile first = bake({});
  for (const char* channel : {"V", "R", "P.Y"}) {  // the scene's centre moves, so floats differ by 2⁻²⁴ of 8
    for (std::size_t i = 0; i < 256; ++i)
      EXPECT_NEAR(first.floats.at(channel)[i], shared.floats.at(channel)[i], 2e-5) << channel << ' ' << i;
  }
  EXPECT_THAT(run({"bake", path("scene.json"), "--mesh", "floor", "--size", "16", "-o", path("map.exr")}).err,
              HasSubstr("a further triangle"));

  // glTF nodes that share a mesh have separate names.
  test::Gltf gltf;
  gltf.at("/meshes").push_back(json::parse(R"({"primitives": [{"attributes": {}, "material": 0}]})"));
  auto& attributes = gltf.at("/meshes/2/primitives/0/attributes");
  attributes["POSITION"] = gltf.add_floats("VEC3", {-1, 0, 1, 1, 0, 1, 1, 0, -1});
  attributes["TEXCOORD_0"] = gltf.add_floats("VEC2", {0, 1, 1, 1, 1, 0});
  for (const auto& [name, x] : {std::pair("One", -3.0), {"Other", 2.5}}) {
    gltf.at("/nodes").push_back({{"name", name}, {"mesh", 2}, {"translation", {x, 0.5, 0}}});
    gltf.at("/scenes/0/nodes").push_back(gltf.at("/nodes").size() - 1);
  }
  write("scene.glb", gltf.glb());
  for (const auto& [name, x] : {std::pair("One", -3.0), {"Other", 2.5}}) {
    ASSERT_EQ(run({"bake", path("scene.glb"), "--mesh", name, "--size", "8", "--margin", "0", "-o", path("map.exr"),
                   "--quiet"})
                  .code,
              0);
    const ExrFile map = read_exr(path("map.exr"));
    for (std::size_t i = 0; i < 64; ++i) {
      EXPECT_EQ(map.floats.at("A")[i], i % 8 + i / 8 >= 7 ? 1 : 0) << name;
      if (map.floats.at("A")[i] == 1) {
        EXPECT_NEAR(map.floats.at("P.X")[i], x - 1 + 2 * (static_cast<double>(i % 8) + 0.5) / 8, 1e-6) << name;
      }
    }
  }
}

TEST_F(Bake, MarginsRepeatTheNearestTexelAndSayThatTheyAreMargins) {
  write("floor.obj",
        "v -4 0 4\nv 4 0 4\nv 4 0 -4\nv -4 0 -4\nvt 0.25 0.25\nvt 0.75 0.25\nvt 0.75 0.75\nvt 0.25 0.75\n"
        "f 1/1 2/2 3/3 4/4\n");
  json scene = baked_floor(false);
  scene["meshes"][0] = {{"name", "floor"}, {"file", "floor.obj"}};
  write("scene.json", scene.dump());
  const ExrFile map = bake({"--margin", "2"});
  const auto at = [&](const char* channel, std::size_t x, std::size_t y) { return map.floats.at(channel)[16 * y + x]; };
  for (std::size_t y = 0; y < 16; ++y) {
    for (std::size_t x = 0; x < 16; ++x) {
      const bool inside = x >= 4 && x < 12 && y >= 4 && y < 12;
      const bool near = x >= 2 && x < 14 && y >= 2 && y < 14;
      EXPECT_EQ(at("A", x, y), inside ? 1 : 0);
      if (inside) {
        EXPECT_EQ(at("P.X", x, y), static_cast<float>(-4 + 8 * (static_cast<double>(x) - 3.5) / 8));
      }
      if (inside) {
        EXPECT_EQ(at("P.Z", x, y), static_cast<float>(-4 + 8 * (static_cast<double>(y) - 3.5) / 8));
      }
      const auto inner = [](std::size_t i) { return std::min<std::size_t>(std::max<std::size_t>(i, 4), 11); };
      EXPECT_EQ(at("R", x, y), near ? at("R", inner(x), inner(y)) : 0) << x << ' ' << y;
      EXPECT_EQ(at("V", x, y), near ? 1 : 0);
    }
  }
}

/// Some texel centres lie on edges of this fan: each must belong to exactly one triangle.
TEST_F(Bake, ATriangulatedSquareHasNoCracks) {
  write("floor.obj",
        "v -4 0 4\nv 4 0 4\nv 4 0 -4\nv -4 0 -4\nv -1.25 0 0.75\nv 2 0 0.75\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "vt 0.34375 0.40625\nvt 0.75 0.40625\nf 1/1 2/2 5/5\nf 2/2 6/6 5/5\nf 2/2 3/3 6/6\nf 3/3 5/5 6/6\n"
        "f 3/3 4/4 5/5\nf 4/4 1/1 5/5\n");
  json scene = baked_floor(false);
  scene["meshes"][0] = {{"name", "floor"}, {"file", "floor.obj"}};
  write("scene.json", scene.dump());
  const Outcome outcome = run({"bake", path("scene.json"), "--mesh", "floor", "--size", "16", "-o", path("map.exr")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err.find("a further triangle"), std::string::npos) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("256 texels"));
  const ExrFile map = read_exr(path("map.exr"));
  for (std::size_t i = 0; i < 256; ++i) {
    const auto x = -4 + 8 * (static_cast<double>(i % 16) + 0.5) / 16;
    EXPECT_EQ(map.floats.at("A")[i], 1);
    EXPECT_NEAR(map.floats.at("P.X")[i], x, 1e-6);
  }
}

TEST_F(Bake, VerticesHaveTheirOwnIrradiance) {
  write("scene.json", baked_floor(false).dump());
  const Outcome outcome = run({"bake", path("scene.json"), "--mesh", "floor", "--vertices", "-o", path("map.ply")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string ply = read("map.ply");
  const std::size_t begin = ply.find("end_header\n") + 11;
  EXPECT_THAT(ply.substr(0, begin),
              testing::AllOf(HasSubstr("element vertex 4\n"), HasSubstr("property float key_V\n")));
  constexpr std::size_t kVertex = 3 * 8 + 3 + 4 * 4 + 4 * 4;
  for (std::size_t i = 0; i < 4; ++i) {
    const char* const vertex = ply.data() + begin + i * kVertex;
    std::array<double, 3> p{};
    std::array<float, 8> values{};
    std::memcpy(p.data(), vertex, sizeof p);
    std::memcpy(values.data(), vertex + 27, sizeof values);
    EXPECT_EQ(std::abs(p[0]), 4);
    EXPECT_EQ(values[0], 1);
    EXPECT_NEAR(values[1], baked_irradiance(p[0], p[2]), 0.02 * baked_irradiance(p[0], p[2]));
    EXPECT_EQ(values[1], values[5]);
  }
  EXPECT_EQ(run({"inspect", path("map.ply"), "--quiet"}).code, 0) << "a mesh file like any other";
}

TEST_F(Bake, GltfNamesItsSet) {
  test::Gltf gltf;
  gltf.at("/meshes").push_back(json::parse(R"({"primitives": [{"attributes": {}, "material": 0}]})"));
  auto& attributes = gltf.at("/meshes/2/primitives/0/attributes");
  attributes["POSITION"] = gltf.add_floats("VEC3", {-1, 0, 1, 1, 0, 1, 1, 0, -1});
  attributes["TEXCOORD_0"] = gltf.add_floats("VEC2", {0, 0, 0, 0, 0, 0});
  attributes["TEXCOORD_1"] = gltf.add_floats("VEC2", {0, 1, 1, 1, 1, 0});
  gltf.at("/nodes").push_back({{"name", "Baked"}, {"mesh", 2}, {"translation", {0, 0.5, 0}}});
  gltf.at("/scenes/0/nodes").push_back(gltf.at("/nodes").size() - 1);
  write("scene.glb", gltf.glb());
  const auto arguments = [&](const char* set) {
    return std::vector<std::string>{"bake", path("scene.glb"), "--mesh", "Baked", "--uv",          set,      "--size",
                                    "8",    "--margin",        "0",      "-o",    path("map.exr"), "--quiet"};
  };
  ASSERT_EQ(run(arguments("1")).code, 0) << run(arguments("1")).err;
  const ExrFile map = read_exr(path("map.exr"));
  for (std::size_t i = 0; i < 64; ++i) {
    const std::size_t x = i % 8, y = i / 8;
    EXPECT_EQ(map.floats.at("A")[i], x + y >= 7 ? 1 : 0) << x << ' ' << y;
    if (x + y >= 7) {
      EXPECT_EQ(map.floats.at("P.X")[i], static_cast<float>(-1 + 2 * (static_cast<double>(x) + 0.5) / 8));
    }
  }
  EXPECT_THAT(run(arguments("0")).err, HasSubstr("covers no texel"));
  EXPECT_THAT(run(arguments("2")).err, HasSubstr("TEXCOORD_2"));
  EXPECT_EQ(run(arguments("2")).code, 3);
}

TEST_F(Bake, RefusesWhatCannotBeMeant) {
  write("scene.json", baked_floor(true).dump());
  const auto code = [&](std::vector<std::string> more) {
    std::vector<std::string> all = {"bake", path("scene.json")};
    all.insert(all.end(), more.begin(), more.end());
    return run(all).code;
  };
  EXPECT_EQ(code({"--mesh", "flor", "-o", path("a.exr")}), 2);
  EXPECT_THAT(run({"bake", path("scene.json"), "--mesh", "flor", "-o", path("a.exr")}).err,
              HasSubstr("did you mean floor"));
  EXPECT_EQ(code({"--mesh", "card", "-o", path("a.exr")}), 3) << "triangles have no coordinates";
  EXPECT_EQ(code({"--mesh", "floor", "-o", path("a.png")}), 2);
  EXPECT_EQ(code({"--mesh", "floor", "--vertices", "-o", path("a.exr")}), 2);
  EXPECT_EQ(code({"--mesh", "floor", "--vertices", "--uv", "0", "-o", path("a.ply")}), 2);
  EXPECT_EQ(code({"--mesh", "floor", "--side", "both", "-o", path("a.exr")}), 2);
  EXPECT_EQ(code({"-o", path("a.exr")}), 2);
  EXPECT_EQ(files(), std::vector<std::string>{"scene.json"});
}

}  // namespace
}  // namespace penumbra::tests
