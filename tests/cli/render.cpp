// SPDX-License-Identifier: Apache-2.0
// Tests `render`: what its files hold, and that the same command gives the same bytes.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"
#include "compare/machine.hpp"
#include "tests/unit/bits_reader.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kSecond =
    R"({"name": "fill", "rectangle": {"center": [3, 3, 3], "halfU": [0.2, 0, 0], "halfV": [0, 0, 0.2]}})";
constexpr const char* kBulb = R"({"name": "bulb", "sphere": {"center": [0, 4, 0], "radius": 0.3}})";

class Render : public ProgramTest, public testing::WithParamInterface<const char*> {
 protected:
  Outcome render(const std::string& out, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"render", path("scene.json"), "-o", path(out), "--method", GetParam()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

TEST_P(Render, WritesItsChannels) {
  tiny_scene();
  const Outcome outcome = render("out.exr", {"--light-samples", "64"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(outcome.out.empty()) << "results of render are files: " << outcome.out;
  const ExrFile image = read_exr(path("out.exr"));
  EXPECT_EQ(image.width, 48u);
  EXPECT_EQ(image.height, 32u);
  for (const char* channel : {"R",
                              "G",
                              "B",
                              "A",
                              "V",
                              "key.V",
                              "key.R",
                              "key.G",
                              "key.B",
                              "P.X",
                              "P.Y",
                              "P.Z",
                              "Prel.X",
                              "Prel.Y",
                              "Prel.Z",
                              "N.X",
                              "N.Y",
                              "N.Z",
                              "Z",
                              "object.X",
                              "material.X",
                              "CryptoObject00.R",
                              "CryptoObject00.G"}) {
    EXPECT_TRUE(image.floats.contains(channel)) << channel;
  }
  EXPECT_TRUE(image.integers.contains("id"));
  for (const char* attribute : {"penumbra.method", "penumbra.options", "penumbra.lightSamples",
                                "penumbra.samplePattern", "penumbra.scene", "penumbra.version", "penumbra.device"}) {
    EXPECT_TRUE(image.attributes.contains(attribute)) << attribute;
  }
  EXPECT_EQ(image.attributes.at("penumbra.method"), GetParam());
  EXPECT_EQ(image.attributes.at("penumbra.lightSamples"), "64");
  const glm::dvec3 origin = image.vectors.at("penumbra.origin");

  bool lit = false, dark = false, between = false, background = false;
  for (std::size_t i = 0; i < image.floats.at("V").size(); ++i) {
    const float v = image.floats.at("V")[i], a = image.floats.at("A")[i];
    ASSERT_TRUE(a == 0 || a == 1);
    ASSERT_TRUE(v >= 0 && v <= 1);
    ASSERT_EQ(v, image.floats.at("key.V")[i]);
    ASSERT_EQ(image.floats.at("R")[i], image.floats.at("key.R")[i]) << "one light: its beauty is all there is";
    if (a == 0) {
      background = true;
      EXPECT_EQ(v, 1);
      EXPECT_EQ(image.floats.at("R")[i], 0);
      EXPECT_EQ(image.floats.at("Z")[i], 1e10f);
      EXPECT_EQ(image.floats.at("P.X")[i], 0);
      EXPECT_EQ(image.integers.at("id")[i], 4294967295u);
      EXPECT_EQ(image.floats.at("object.X")[i], 0);
      continue;
    }
    lit = lit || v == 1;
    dark = dark || v == 0;
    between = between || (v > 0 && v < 1);
    if (v == 0) {
      EXPECT_EQ(image.floats.at("R")[i], 0);
    }
    EXPECT_LT(image.integers.at("id")[i], 4u);
    EXPECT_GT(image.floats.at("Z")[i], 0);
    EXPECT_FLOAT_EQ(image.floats.at("P.Y")[i], static_cast<float>(image.floats.at("Prel.Y")[i] + origin.y));
  }
  EXPECT_TRUE(lit && dark && between && background) << lit << dark << between << background;
}

TEST_P(Render, SameCommandSameBytes) {
  tiny_scene();
  ASSERT_EQ(render("out.exr").code, 0);
  const std::string first = read("out.exr");
  ASSERT_EQ(render("out.exr").code, 0);
  EXPECT_EQ(first, read("out.exr"));
}

TEST_P(Render, BitsAgreeWithTheImage) {
  tiny_scene();
  const Outcome outcome =
      render("out.exr", {"--bits", path("out.bits"), "--light-samples", "7x9", "--sample-pattern", "grid"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const ExrFile image = read_exr(path("out.exr"));
  const tests::BitsFile bits = tests::read_bits(path("out.bits"));
  EXPECT_EQ(bits.width, 48u);
  EXPECT_EQ(bits.height, 32u);
  ASSERT_EQ(bits.sample_count, 63u);
  EXPECT_EQ(bits.origin, image.vectors.at("penumbra.origin"));
  ASSERT_EQ(bits.words_per_mask(), 2u);
  for (std::size_t i = 0; i < bits.p.size(); ++i) {
    EXPECT_EQ(bits.p[i].x, image.floats.at("Prel.X")[i]);
    EXPECT_EQ(static_cast<std::uint32_t>(bits.triangle[i]), image.integers.at("id")[i]);
    EXPECT_EQ(bits.masks[2 * i + 1] >> 31, 0u) << "bit 63 belongs to no light sample";
    const int count = std::popcount(bits.masks[2 * i]) + std::popcount(bits.masks[2 * i + 1]);
    EXPECT_NEAR(image.floats.at("V")[i], count / 63.0, 1e-6);
  }
}

TEST_P(Render, StatsAndPng) {
  tiny_scene();
  const Outcome outcome =
      render("out.exr", {"--stats", path("stats.json"), "--png", path("out.png"), "--light-samples", "16"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(read("out.png").substr(1, 3), "PNG");
  const json stats = json::parse(read("stats.json"));
  EXPECT_EQ(stats.at("method"), GetParam());
  EXPECT_EQ(stats.at("size"), json::array({48, 32}));
  EXPECT_EQ(stats.at("triangles"), 4);
  EXPECT_EQ(stats.at("lightSamples"), 16);
  EXPECT_EQ(stats.at("samplePattern"), "rows");
  for (const char* key : {"device", "scene", "options", "passes", "peakMemoryBytes", "counters", "warnings"}) {
    EXPECT_TRUE(stats.contains(key)) << key;
  }
  std::uint64_t held = 0;
  for (const char* key : {"scene", "sceneFloats", "viewSamples", "answers"}) {
    held += stats.at("memory").at(key).get<std::uint64_t>();
  }
  EXPECT_EQ(stats["memory"].at("method"), stats["peakMemoryBytes"]) << "which may be the device's";
  EXPECT_GE(stats["memory"]["viewSamples"], 48 * 32 * 33) << "a triangle, p, n, depth and facing a pixel";
  EXPECT_LE(held, stats["memory"].at("peakResident").get<std::uint64_t>());
  for (const char* key : {"load", "mesh", "view", "light", "evaluate", "shadow", "total"}) {
    EXPECT_GE(stats.at("seconds").at(key).get<double>(), 0) << key;
  }
  // Phases of one picture do not overlap; the system tells the process's start to a hundredth of a second.
  double sum = 0;
  for (const char* key : {"load", "mesh", "view", "light", "evaluate", "beauty", "write"})
    sum += stats["seconds"].at(key).get<double>();
  EXPECT_LE(sum, stats["seconds"]["total"].get<double>() + 0.02);
  EXPECT_TRUE(stats.at("seconds").at("warmup").is_null()) << "one run: nothing was discarded";
  EXPECT_DOUBLE_EQ(stats["seconds"]["shadow"].get<double>(),
                   stats["seconds"]["light"].get<double>() + stats["seconds"]["evaluate"].get<double>());
}

TEST_P(Render, RoundedCountsAreSaid) {
  tiny_scene();
  const Outcome outcome = render("out.exr", {"--light-samples", "250", "--stats", path("stats.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  // L = round(√250) = 16 rows of B = ceil(250 / 16) = 16.
  EXPECT_EQ(json::parse(read("stats.json")).at("lightSamples"), 256);
  EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("250"), HasSubstr("256")));
}

TEST_P(Render, ChosenLightComesFirst) {
  write("scene.json", scene_text_with("/lights/1", kSecond));
  ASSERT_EQ(render("key.exr").code, 0);
  ASSERT_EQ(render("fill.exr", {"--light", "fill", "--light", "key"}).code, 0);
  const ExrFile key = read_exr(path("key.exr")), fill = read_exr(path("fill.exr"));
  EXPECT_EQ(key.floats.at("V"), key.floats.at("key.V"));
  EXPECT_EQ(fill.floats.at("V"), fill.floats.at("fill.V"));
  EXPECT_EQ(key.floats.at("fill.V"), fill.floats.at("fill.V"));
  EXPECT_NE(key.floats.at("V"), fill.floats.at("V"));
}

INSTANTIATE_TEST_SUITE_P(With, Render, testing::Values("raytrace", "view-sample", "edge-scatter"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::erase(name, '-');
                           return name;
                         });

using RenderOnce = ProgramTest;

TEST_F(RenderOnce, ImageMethodsSayHowTheyMakeBeauty) {
  tiny_scene();
  for (const char* method : {"shadow-map", "pcss", "accumulate"}) {
    const Outcome outcome = run({"render", path("scene.json"), "-o", path("out.exr"), "--method", method,
                                 "--light-samples", "16", "--method-option", "size=256"});
    ASSERT_EQ(outcome.code, 0) << method << ": " << outcome.err;
    const ExrFile image = read_exr(path("out.exr"));
    EXPECT_EQ(image.attributes.at("penumbra.options"), "size=256");
    const bool mask = image.attributes.at("penumbra.output") == "mask";
    EXPECT_THAT(image.attributes.at("penumbra.beauty"), HasSubstr(mask ? "sample by sample" : "V times"));
    EXPECT_EQ(std::ranges::count_if(image.floats.at("V"), [](float v) { return !(v >= 0 && v <= 1); }), 0) << method;
    EXPECT_GT(std::ranges::count(image.floats.at("V"), 0.0f), 0) << method;
  }
  const Outcome bits =
      run({"render", path("scene.json"), "-o", path("b.exr"), "--method", "pcss", "--bits", path("out.bits")});
  EXPECT_EQ(bits.code, 2);
  EXPECT_THAT(bits.err, HasSubstr("pcss"));
  // With subsample the method gives V only: beauty is V times the unshadowed light, and --bits is refused.
  const std::vector<std::string> few = {"render",  path("scene.json"), "-o",      path("few.exr"),   "--method",
                                        "bitmask", "--method-option",  "size=64", "--method-option", "subsample=2"};
  ASSERT_EQ(run(few).code, 0);
  EXPECT_EQ(read_exr(path("few.exr")).attributes.at("penumbra.output"), "scalar");
  std::vector<std::string> few_bits = few;
  few_bits.insert(few_bits.end(), {"--bits", path("few.bits")});
  EXPECT_EQ(run(few_bits).code, 2);
}

/// Picture and stats name what computed the shadow: the processor if its vector units did, otherwise the Vulkan device.
TEST_F(RenderOnce, SaysWhatItRanOn) {
  tiny_scene();
  const auto ran_on = [&](const std::string& method, const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"render", path("scene.json"), "-o", path("out.exr"), "--method",
                                          method,   "--light-samples",  "16", "--stats",       path("stats.json")};
    for (const std::string& option : options) arguments.insert(arguments.end(), {"--method-option", option});
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    auto device = json::parse(read("stats.json")).at("device").get<std::string>();
    EXPECT_EQ(read_exr(path("out.exr")).attributes.at("penumbra.device"), device);
    return device;
  };
  const std::string processor = compare::this_machine().processor;
  const json devices = json::parse(run({"devices", "--json"}).out).at("devices");
  for (const char* method : {"edge-scatter", "view-sample"}) {
    EXPECT_EQ(ran_on(method, {"engine=native"}), processor) << method;
    const std::string device = ran_on(method, {"engine=vulkan"});
    EXPECT_TRUE(std::ranges::any_of(devices, [&](const json& one) { return one.at("name") == device; })) << device;
  }
  EXPECT_EQ(ran_on("edge-scatter", {"rows=exact"}), processor);
  EXPECT_EQ(ran_on("raytrace", {}), processor);
}

TEST_F(RenderOnce, DefaultMethodCanDoThePattern) {
  const Outcome outcome = run({"render", tiny_scene(), "-o", path("out.exr"), "--sample-pattern", "sobol"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(read_exr(path("out.exr")).attributes.at("penumbra.method"), "edge-scatter");
  // Both engines can do this, and give the same bits.
  std::vector<std::string> bits;
  for (const char* engine : {"engine=vulkan", "engine=native"}) {
    const Outcome named = run({"render", tiny_scene(), "-o", path("out.exr"), "--sample-pattern", "jittered",
                               "--method", "edge-scatter", "--method-option", engine, "--bits", path("out.bits")});
    EXPECT_EQ(named.code, 0) << named.err;
    bits.push_back(read("out.bits"));
  }
  EXPECT_EQ(bits[0], bits[1]);
}

TEST_F(RenderOnce, SpheresAreNotForTheDevice) {
  write("scene.json", scene_text_with("/lights/0", kBulb));
  const Outcome named = run({"render", path("scene.json"), "-o", path("out.exr"), "--light-samples", "16", "--method",
                             "edge-scatter", "--method-option", "engine=vulkan"});
  EXPECT_EQ(named.code, 3);
  EXPECT_THAT(
      named.err,
      HasSubstr(
          "is a sphere; method edge-scatter supports a sphere, but not with engine=vulkan. Leave the option out"));
}

TEST_F(RenderOnce, MeshesOutsideTheRuleAreAlwaysLit) {
  write("scene.json", scene_text_with("/meshes/0/receivesShadow", "false"));
  const Outcome outcome =
      run({"render", path("scene.json"), "-o", path("out.exr"), "--method", "raytrace", "--bits", path("out.bits")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const ExrFile image = read_exr(path("out.exr"));
  const tests::BitsFile bits = tests::read_bits(path("out.bits"));
  for (std::size_t i = 0; i < bits.p.size(); ++i) {
    if (image.integers.at("id")[i] == 2 || image.integers.at("id")[i] == 3) continue;  // not floor, not background
    EXPECT_EQ(image.floats.at("V")[i], 1);
    for (std::size_t word = 0; word < 8; ++word) EXPECT_EQ(bits.masks[8 * i + word], 0xffffffffu);
  }
}

TEST_F(RenderOnce, BitsOfASphereAreRefused) {
  write("scene.json", scene_text_with("/lights/0", kBulb));
  const Outcome bits =
      run({"render", path("scene.json"), "-o", path("out.exr"), "--method", "raytrace", "--bits", path("out.bits")});
  EXPECT_EQ(bits.code, 2);
  EXPECT_THAT(bits.err, HasSubstr("sphere"));
  EXPECT_EQ(run({"render", path("scene.json"), "-o", path("out.exr"), "--method", "raytrace"}).code, 0);
  const Outcome by_default = run({"render", path("scene.json"), "-o", path("other.exr"), "--light-samples", "16"});
  EXPECT_EQ(by_default.code, 0) << by_default.err;
  EXPECT_EQ(read_exr(path("other.exr")).attributes.at("penumbra.method"), "edge-scatter");
}

TEST_F(RenderOnce, FramesAreNumbered) {
  tiny_scene();
  const Outcome outcome = run({"render", path("scene.json"), "-o", path("out.exr"), "--method", "raytrace", "--frames",
                               "9-11", "--light-samples", "4"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(files(), ElementsAre("out.0009.exr", "out.0010.exr", "out.0011.exr", "scene.json"));
  ASSERT_EQ(run({"render", path("scene.json"), "-o", path("f%02d.exr"), "--method", "raytrace", "--frames", "1-1",
                 "--light-samples", "4"})
                .code,
            0);
  EXPECT_TRUE(std::filesystem::exists(path("f01.exr")));
}

TEST_F(RenderOnce, QuietIsQuiet) {
  const Outcome outcome = run({"render", tiny_scene(), "-o", path("out.exr"), "--method", "raytrace", "--quiet"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err + outcome.out, "");
}

}  // namespace
}  // namespace penumbra::tests
