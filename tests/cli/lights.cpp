// SPDX-License-Identifier: Apache-2.0
// Tests kinds of lights from the scene file to the picture, and lights that are linked to meshes.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"
#include "tests/unit/bits_reader.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr const char* kCeiling = R"("rectangle": {"center": [0, 4, 0], "halfU": [0.5, 0, 0], "halfV": [0, 0, 0.5]})";
constexpr const char* kLowSun = R"("sun": {"direction": [0.2, -1, 0.1], "angle": 20})";

class LightKinds : public ProgramTest {
 protected:
  /// A floor, a board over it and a shelf next to the board, under these lights.
  std::string scene_with(const std::string& lights, const std::string& of_board = "",
                         const std::string& of_floor = "") const {
    const std::string text = R"({"format": "penumbra-scene/1", "size": [48, 32],
      "camera": {"eye": [2, 3, 6], "target": [0, 0.5, 0], "verticalFov": 45},
      "meshes": [
        {"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [4, 0, 0], "halfV": [0, 0, -4]})" +
                             of_floor + R"(},
        {"name": "board", "triangles": [[-1,1,-1, 1,1,-1, 0,1.5,1], [-1,1,-1, 0,1.5,1, -1,0.2,1]])" +
                             of_board + R"(},
        {"name": "shelf", "quad": {"center": [1.5, 0.5, 0.5], "halfU": [0.4, 0, 0], "halfV": [0, 0, -0.4]}}],
      "lights": [)" + lights +
                             "]}";
    return write("scene.json", text).string();
  }
  Outcome render(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"render", path("scene.json"), "-o", path("out.exr")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

TEST_F(LightKinds, EachIsRenderedWithoutAMethodNamed) {
  for (const char* shape :
       {kCeiling, kLowSun, R"("disk": {"center": [0, 4, 0], "normal": [0, -1, 0], "radius": 0.6})",
        R"("ellipse": {"center": [0, 4, 0], "halfU": [0.9, 0, 0], "halfV": [0, 0, 0.4]})",
        R"("polygon": [[-0.5, 4, -0.5], [0.5, 4, -0.5], [0, 4, 0.6]])",
        R"("sphere": {"center": [0, 4, 0], "radius": 0.6})", R"("sun": {"direction": [0.2, -1, 0.1], "angle": 0})"}) {
    scene_with(fmt::format(R"({{"name": "key", {}}})", shape));
    const Outcome outcome = render({"--light-samples", "64"});
    ASSERT_EQ(outcome.code, 0) << shape << outcome.err;
    const ExrFile image = read_exr(path("out.exr"));
    bool lit = false, dark = false;
    for (std::size_t i = 0; i < image.floats.at("V").size(); ++i) {
      if (image.floats.at("A")[i] == 0) continue;
      lit |= image.floats.at("V")[i] > 0.9f && image.floats.at("R")[i] > 0;
      dark |= image.floats.at("V")[i] < 0.1f;
    }
    EXPECT_TRUE(lit && dark) << shape;
  }
}

TEST_F(LightKinds, WhatCannotBeDoneIsRefusedWithWhatCan) {
  scene_with(fmt::format(R"({{"name": "key", {}}})", kLowSun));
  for (const char* method : {"soft-volume", "wedge-ramp", "hard-volume"}) {
    const Outcome outcome = render({"--method", method});
    EXPECT_EQ(outcome.code, 3) << method;
    EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("is a sun"), HasSubstr("raytrace"))) << method;
  }
  scene_with(R"({"name": "key", "sun": {"direction": [0.2, -1, 0.1], "angle": 179.999}})");
  for (const char* method : {"view-sample-planar", "hierarchical-penumbra", "view-sample:variant=sintorn"}) {
    const std::string text(method);
    const std::size_t colon = text.find(':');
    std::vector<std::string> arguments = {"--method", text.substr(0, colon)};
    if (colon != text.npos) arguments.insert(arguments.end(), {"--method-option", text.substr(colon + 1)});
    const Outcome outcome = render(arguments);
    EXPECT_EQ(outcome.code, 3) << method;
    EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("179.5 degrees"), HasSubstr("edge-scatter"))) << method;
  }
  scene_with(fmt::format(R"({{"name": "key", {}}})", kLowSun));
  const Outcome wedges = run({"wedges", path("scene.json"), "--light", "key"});
  EXPECT_EQ(wedges.code, 3);
  EXPECT_THAT(wedges.err, HasSubstr("is a sun"));
  scene_with(fmt::format(R"({{"name": "key", {}, "radiance": [1e300, 1, 1]}})", kCeiling));
  const Outcome blinding = render({});
  EXPECT_EQ(blinding.code, 3);
  EXPECT_THAT(blinding.err, testing::AllOf(HasSubstr("1e+300"), HasSubstr("1e+36")));
  scene_with(R"({"name": "key", "sphere": {"center": [0, 4, 0], "radius": 0.6}})");
  EXPECT_EQ(render({"--light", ""}).code, 2);
  EXPECT_EQ(render({"--quiet=7"}).code, 2);
  EXPECT_EQ(render({"--skip-existing=3"}).code, 2);
  EXPECT_EQ(render({"--method", "raytrace", "--bits", path("out.bits")}).code, 2);
  EXPECT_EQ(render({"--method", "raytrace", "--sun-angle", "180"}).code, 2);
  EXPECT_EQ(render({"--method", "raytrace", "--lamp-radius", "0"}).code, 2);
}

/// The shipped scene with seven kinds: each light alone gives its exact area without being asked.
TEST_F(LightKinds, ShippedLightsHaveExactAreas) {
  const std::string file = PENUMBRA_SCENES "/lights.json";
  const json scene = json::parse(std::ifstream(file));
  std::vector<std::string> kinds;
  for (const json& light : scene.at("lights")) {
    const auto name = light.at("name").get<std::string>();
    const Outcome outcome =
        run({"render", file, "-o", path("out.exr"), "--size", "24x24", "--light", name, "--stats", path("stats.json")});
    ASSERT_EQ(outcome.code, 0) << name << outcome.err;
    const json stats = json::parse(read("stats.json"));
    EXPECT_EQ(stats.at("lights").at(0).at("quantity"), "area") << name;
    const std::vector<float> v = read_exr(path("out.exr")).floats.at("V");
    EXPECT_GT(std::ranges::count_if(v, [](float share) { return share > 0 && share < 1; }), 20) << name;
    for (const char* kind : {"rectangle", "disk", "ellipse", "polygon", "sphere", "sun"}) {
      if (light.contains(kind)) kinds.emplace_back(light.contains("texture") ? "window" : kind);
    }
  }
  EXPECT_THAT(kinds,
              testing::UnorderedElementsAre("rectangle", "window", "disk", "ellipse", "polygon", "sphere", "sun"));
}

TEST_F(LightKinds, BitsOfASunHoldDirections) {
  scene_with(fmt::format(R"({{"name": "key", {}}})", kLowSun));
  const Outcome outcome = render({"--method", "raytrace", "--bits", path("out.bits"), "--light-samples", "5x5"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const tests::BitsFile bits = tests::read_bits(path("out.bits"));
  ASSERT_EQ(bits.light_points.size(), 25u);
  const glm::dvec3 middle = -glm::normalize(glm::dvec3(0.2, -1, 0.1));
  for (const glm::vec3& d : bits.light_points) {
    EXPECT_NEAR(glm::dot(glm::dvec3(d), middle), 1, 1e-6);
    EXPECT_LE(glm::length(glm::dvec3(d) - middle), std::tan(10 * M_PI / 180) + 1e-6);
  }
}

/// An object that does not cast for one light is to this light as if it cast for none; other lights are unaffected.
TEST_F(LightKinds, CastersAreEachLightsOwn) {
  const std::string other = fmt::format(R"({{"name": "other", {}}})", kCeiling);
  const auto bits_of = [&](const char* method, const char* light) {
    const Outcome outcome =
        render({"--method", method, "--light", light, "--bits", path("out.bits"), "--light-samples", "6x6"});
    EXPECT_EQ(outcome.code, 0) << method << outcome.err;
    return read("out.bits");
  };
  for (const char* method :
       {"raytrace", "view-sample", "depth-complexity", "accumulate", "hierarchical-penumbra", "view-sample-planar"}) {
    scene_with(fmt::format(R"({{"name": "key", {}}}, {})", kCeiling, other), R"(, "castsShadow": false)");
    const std::string none = bits_of(method, "key");
    scene_with(fmt::format(R"({{"name": "key", {}}}, {})", kCeiling, other));
    const std::string all = bits_of(method, "key");
    EXPECT_NE(none, all);
    for (const char* casters : {R"({"exclude": ["board"]})", R"({"include": ["floor", "shelf"]})"}) {
      scene_with(fmt::format(R"({{"name": "key", {}, "casters": {}}}, {})", kCeiling, casters, other));
      EXPECT_EQ(bits_of(method, "key"), none) << method << casters;
      EXPECT_EQ(bits_of(method, "other"), all) << method << casters;
    }
  }
}

TEST_F(LightKinds, AMeshIsLitByItsLightsAlone) {
  const std::string lights = fmt::format(R"({{"name": "key", {0}}}, {{"name": "other", {0}}})", kCeiling);
  for (const char* method : {"raytrace", "pcss"}) {
    scene_with(lights, "", R"(, "lights": ["other"])");
    ASSERT_EQ(render({"--method", method}).code, 0);
    const ExrFile image = read_exr(path("out.exr"));
    scene_with(lights);
    ASSERT_EQ(render({"--method", method, "--light", "other", "--light", "key"}).code, 0);
    const ExrFile plain = read_exr(path("out.exr"));
    std::size_t floor = 0, above = 0;
    for (std::size_t i = 0; i < image.floats.at("V").size(); ++i) {
      if (image.floats.at("A")[i] == 0) continue;
      const bool on_floor = image.integers.at("id")[i] < 2;
      const float expected = on_floor ? 0 : plain.floats.at("V")[i];  // both lights are alike
      EXPECT_EQ(image.floats.at("V")[i], expected) << method;
      // Lit by one of two lights that are alike, the floor is half as bright.
      if (on_floor) {
        EXPECT_NEAR(2 * image.floats.at("R")[i], plain.floats.at("R")[i], 1e-5f * plain.floats.at("R")[i]);
      }
      ++(on_floor ? floor : above);
    }
    EXPECT_GT(floor, 100u);
    EXPECT_GT(above, 10u);
  }
}

/// Lamps keep their sizes and units when converted to glTF and back.
TEST_F(LightKinds, LampsGoThroughGltf) {
  const auto scene =
      scene_with(R"({"name": "sun", "sun": {"direction": [0.2, -1, 0.1], "angle": 20}, "irradiance": [3, 2, 1]},
    {"name": "bulb", "sphere": {"center": [0, 4, 0], "radius": 0.25}, "radiance": [7, 8, 9]})");
  ASSERT_EQ(run({"convert", scene, "-o", path("scene.glb")}).code, 0);
  ASSERT_EQ(run({"convert", path("scene.glb"), "-o", path("again.json")}).code, 0);
  const auto again = nlohmann::json::parse(read("again.json"));
  ASSERT_EQ(again["lights"].size(), 2u);
  EXPECT_EQ(again["lights"][0]["sun"]["angle"], 20);
  const double sine = std::sin(10 * M_PI / 180);
  EXPECT_NEAR(again["lights"][0]["radiance"][0].get<double>() * M_PI * sine * sine, 3, 1e-9);
  EXPECT_EQ(again["lights"][1]["sphere"]["radius"], 0.25);
  EXPECT_NEAR(again["lights"][1]["radiance"][2].get<double>(), 9, 1e-9);
}

}  // namespace
}  // namespace penumbra::tests
