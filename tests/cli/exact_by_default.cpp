// SPDX-License-Identifier: Apache-2.0
// Tests `render` without options: it gives exact areas unless light samples are asked for, and which options ask for
// them.

#include "tests/cli/program.hpp"

#include "base/exr.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kFill =
    R"({"name": "fill", "rectangle": {"center": [3, 3, 3], "halfU": [0.2, 0, 0], "halfV": [0, 0, 0.2]}})";
constexpr const char* kSun = R"({"name": "noon", "sun": {"direction": [-0.3, -1, -0.2], "angle": 2}})";

class ExactByDefault : public ProgramTest {
 protected:
  struct Rendered {
    ExrFile image;
    json stats;
    std::string err;
  };
  [[nodiscard]] Rendered render(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"render",        path("scene.json"), "-o",
                                          path("out.exr"), "--stats",          path("stats.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    if (outcome.code != 0) return {};
    return {read_exr(path("out.exr")), json::parse(read("stats.json")), outcome.err};
  }
  /// Expects both files to say this about the first light.
  static void expect_first_light(const Rendered& rendered, const json& expected) {
    const json &stats = rendered.stats, &light = stats.at("lights").at(0);
    const auto& header = rendered.image.attributes;
    const json lights = json::parse(header.at("penumbra.lights"));
    for (const auto& [key, value] : expected.items()) {
      EXPECT_EQ(light.at(key), value) << key;
      EXPECT_EQ(lights.at(0).at(key), value) << key;
      if (key != "quantity") {
        EXPECT_EQ(stats.at(key), value) << key;
      }
    }
    EXPECT_EQ(header.at("penumbra.method"), light.at("method"));
    EXPECT_EQ(header.at("penumbra.lightSamples"), light.at("lightSamples").dump());
    EXPECT_EQ(header.at("penumbra.samplePattern"),
              light.at("samplePattern").is_null() ? "null" : light.at("samplePattern").get<std::string>());
    EXPECT_FALSE(lights.at(0).contains("seconds")) << "the same command gives the same bytes";
    EXPECT_GE(light.at("seconds").at("shadow").get<double>(), 0);
  }
};

TEST_F(ExactByDefault, WhereNobodyAsksForLightSamples) {
  tiny_scene();
  const Rendered rendered = render({});
  expect_first_light(rendered, {{"method", "edge-scatter"},
                                {"options", {{"rows", "exact"}}},
                                {"lightSamples", 0},
                                {"samplePattern", nullptr},
                                {"quantity", "area"}});
  EXPECT_EQ(rendered.image.attributes.at("penumbra.options"), "rows=exact");
  EXPECT_EQ(rendered.image.attributes.at("penumbra.output"), "radiance");
  EXPECT_THAT(rendered.stats.at("warnings"), testing::IsEmpty());
  EXPECT_THAT(rendered.err, HasSubstr("exact areas"));
  const std::vector<float> exact = render({"--method", "exact"}).image.floats.at("V");
  for (std::size_t i = 0; i < exact.size(); ++i) EXPECT_FLOAT_EQ(rendered.image.floats.at("V")[i], exact[i]) << i;
}

TEST_F(ExactByDefault, ThreeOptionsAskForLightSamples) {
  tiny_scene();
  json counts = {{"method", "edge-scatter"}, {"lightSamples", 256}, {"samplePattern", "rows"}, {"quantity", "count"}};
  counts["options"] = json::object();
  expect_first_light(render({"--sample-pattern", "rows"}), counts);
  expect_first_light(render({"--bits", path("out.bits")}), counts);
  counts["lightSamples"] = 16;
  expect_first_light(render({"--light-samples", "16"}), counts);
}

/// A named method is kept, and its own options override the default.
TEST_F(ExactByDefault, OfAMethodThatWasNamedToo) {
  tiny_scene();
  EXPECT_EQ(render({"--method", "edge-scatter"}).stats["lights"][0]["quantity"], "area");
  EXPECT_EQ(render({"--method", "edge-scatter", "--light-samples", "9"}).stats["lightSamples"], 9);
  const Rendered unused = render({"--method", "exact", "--light-samples", "9"});
  EXPECT_THAT(unused.err, HasSubstr("--light-samples: exact computes areas, and uses no light samples"));
  EXPECT_THAT(unused.stats["warnings"].dump(), HasSubstr("uses no light samples"));
  EXPECT_THAT(render({"--method", "exact"}).err, Not(HasSubstr("light samples")));
  for (const char* option : {"rows=samples", "engine=vulkan"}) {
    const Rendered samples = render({"--method", "edge-scatter", "--method-option", option});
    EXPECT_EQ(samples.stats["lights"][0]["quantity"], "count") << option;
    EXPECT_THAT(samples.err, testing::AllOf(HasSubstr("\"key\""), HasSubstr("256 light samples"))) << option;
    EXPECT_EQ(render({"--method-option", option}).stats["lights"][0]["options"], samples.stats["options"]);
  }
  const Rendered rays = render({"--method", "raytrace"});
  EXPECT_EQ(rays.stats["lightSamples"], 256);
  EXPECT_THAT(rays.stats["warnings"].dump(), HasSubstr("raytrace does not give its exact area"));
  EXPECT_EQ(run({"render", path("scene.json"), "-o", path("out.exr"), "--method-option", "search=hsm"}).code, 2);
}

/// A method that uses no light samples does not report any.
TEST_F(ExactByDefault, EstimatesAreNoCounts) {
  tiny_scene();
  const Rendered hard = render({"--method", "alias-free"});
  expect_first_light(hard,
                     {{"method", "alias-free"}, {"lightSamples", 0}, {"samplePattern", nullptr}, {"quantity", "area"}});
  EXPECT_THAT(hard.err,
              testing::AllOf(HasSubstr("an estimate of V"), HasSubstr("the hard shadow of the light's centre"),
                             Not(HasSubstr("256")), Not(HasSubstr("exact area"))));
}

/// A sun among rectangle lights: each light's V does not depend on the order of lights.
TEST_F(ExactByDefault, LightByLight) {
  write("scene.json", scene_text_with("/lights/1", kSun));
  json both = json::parse(read("scene.json"));
  both["lights"].push_back(json::parse(kFill));
  write("scene.json", both.dump());
  const Rendered rendered = render({});
  const json lights = rendered.stats.at("lights");
  ASSERT_EQ(lights.size(), 3U);
  EXPECT_EQ(lights[1]["name"], "noon");
  for (const json& light : lights) {
    EXPECT_EQ(light["method"], "edge-scatter");
    EXPECT_EQ(light["quantity"], "area");
  }
  const auto& v = rendered.image.floats;
  const Rendered sun_first = render({"--light", "noon", "--light", "key", "--light", "fill"});
  for (const char* channel : {"key.V", "noon.V", "fill.V"})
    EXPECT_EQ(v.at(channel), sun_first.image.floats.at(channel)) << channel;
}

}  // namespace
}  // namespace penumbra::tests
