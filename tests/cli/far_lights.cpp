// SPDX-License-Identifier: Apache-2.0
// Tests lights that the default method cannot represent in float32 together with the scene: another method takes its
// place and says so.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class FarLights : public ProgramTest {
 protected:
  struct Rendered {
    std::vector<float> v;
    std::string method, err;
  };
  /// The tiny scene under another light, 24 x 16.
  [[nodiscard]] Rendered render(const std::string& light, std::vector<std::string> more = {}) const {
    write("far.json", scene_text_with("/lights", "[" + light + "]"));
    std::vector<std::string> arguments = {"render",  path("far.json"), "-o",     path("out.exr"),
                                          "--stats", path("s.json"),   "--size", "24x16"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << light << outcome.err;
    if (outcome.code != 0) return {};
    return {read_exr(path("out.exr")).floats.at("V"), json::parse(read("s.json")).at("lights")[0].at("method"),
            outcome.err};
  }
  static double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
    double largest = a.size() == b.size() ? 0 : 1;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      largest = std::max(largest, std::abs(double{a[i]} - double{b[i]}));
    return largest;
  }
};

/// A sphere of the sun's size at the sun's distance, in metres, equals a sun of that angle: the direction to its centre
/// differs by 10 / 1.5e11 across the scene.
TEST_F(FarLights, AStarIsASun) {
  const double distance = 1.5e11, radius = 6.96e8;
  const double angle = 2 * std::asin(radius / distance) * 180 / std::numbers::pi;
  const Rendered star = render(fmt::format(R"({{"name": "sol", "sphere": {{"center": [{}, {}, 0], "radius": {}}}}})",
                                           0.6 * distance, 0.8 * distance, radius));
  EXPECT_EQ(star.method, "exact");
  EXPECT_THAT(star.err,
              HasSubstr("\"sol\": too far away, or too large or too small relative to the scene, for edge-scatter"));
  const Rendered sun =
      render(fmt::format(R"({{"name": "sol", "sun": {{"direction": [-0.6, -0.8, 0], "angle": {}}}}})", angle));
  EXPECT_EQ(sun.method, "edge-scatter");
  EXPECT_LT(largest_difference(star.v, sun.v), 1e-5);
  // Rays use light samples; their V is that of the area, up to the error of counting.
  const Rendered rays = render(R"({"name": "sol", "sphere": {"center": [9e10, 1.2e11, 0], "radius": 6.96e8}})",
                               {"--light-samples", "256"});
  EXPECT_EQ(rays.method, "raytrace");
  EXPECT_THAT(rays.err, HasSubstr("raytrace is used instead"));
  EXPECT_LT(largest_difference(rays.v, sun.v), 0.1);
}

TEST_F(FarLights, EveryKindIsDone) {
  const std::pair<const char*, const char*> lights[] = {
      {"huge",
       R"({"name": "huge", "rectangle": {"center": [0, 1e10, 0], "halfU": [1e10, 0, 0], "halfV": [0, 0, 1e10]}})"},
      {"tiny", R"({"name": "tiny", "rectangle": {"center": [0, 3, 0], "halfU": [1e-9, 0, 0], "halfV": [0, 0, 1e-9]}})"},
      {"disk", R"({"name": "disk", "disk": {"center": [1e11, 2e11, 0], "normal": [-1, -2, 0], "radius": 1e9}})"},
      {"oval", R"({"name": "oval", "ellipse": {"center": [0, 2e11, 0], "halfU": [1e9, 0, 0], "halfV": [0, 0, 2e9]}})"},
      {"poly", R"({"name": "poly", "polygon": [[0, 1e10, 0], [1e9, 1e10, 0], [0, 1e10, 1e9]], "twoSided": true})"},
      {"ball", R"({"name": "ball", "sphere": {"center": [1, 3, 0], "radius": 1e-9}})"}};
  for (const auto& [name, light] : lights) {
    const Rendered rendered = render(light);
    EXPECT_EQ(rendered.method, "exact") << name;
    EXPECT_THAT(rendered.err, HasSubstr("exact is used instead")) << name;
    for (const float v : rendered.v) EXPECT_TRUE(v >= 0 && v <= 1) << name << " " << v;
    EXPECT_EQ(render(light, {"--light-samples", "16"}).method, "raytrace") << name;
  }
}

/// Areas work beyond the reach of Embree's float32, too. Coordinates end at 1e12, so the scene is small.
TEST_F(FarLights, BeyondRaysAreAreas) {
  write("small.json", R"({"format": "penumbra-scene/1", "size": [12, 8],
    "camera": {"eye": [0, 0.002, 0.003], "target": [0, 0, 0]},
    "meshes": [{"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [0.001, 0, 0], "halfV": [0, 0, -0.001]}}],
    "lights": [{"name": "far", "disk": {"center": [0, 9e11, 0], "normal": [0, -1, 0], "radius": 1e10}}]})");
  const Outcome outcome =
      run({"render", path("small.json"), "-o", path("out.exr"), "--light-samples", "16", "--stats", path("s.json")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("exact, without light samples, is used instead"));
  EXPECT_EQ(json::parse(read("s.json")).at("lights")[0].at("method"), "exact");
  EXPECT_THAT(read_exr(path("out.exr")).floats.at("V"), testing::Each(1.0F));
}

/// A named method is not replaced; a comparison leaves out, by name, those of its methods that cannot handle the light.
TEST_F(FarLights, ANamedMethodRefuses) {
  write("far.json",
        scene_text_with("/lights", R"([{"name": "ball", "sphere": {"center": [0, 1e12, 0], "radius": 1e10}}])"));
  const Outcome named = run({"render", path("far.json"), "-o", path("out.exr"), "--method", "edge-scatter"});
  EXPECT_EQ(named.code, 3);
  EXPECT_THAT(named.err, HasSubstr("edge-scatter handles lights between"));
  const Outcome group = run({"compare", path("far.json"), "-o", path("dir"), "--methods", "geometry,raytrace", "--size",
                             "12x8", "--runs", "1"});
  EXPECT_EQ(group.code, 0) << group.err;
  EXPECT_THAT(group.err, HasSubstr("edge-scatter is left out"));
}

}  // namespace
}  // namespace penumbra::tests
