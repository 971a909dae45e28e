// SPDX-License-Identifier: Apache-2.0
// Tests `compare`: the files it writes, the numbers it reports, and its exit codes.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"
#include "tests/report_json.hpp"
#include "tests/unit/bits_reader.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <bit>
#include <cmath>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Compare : public ProgramTest {
 protected:
  Outcome compare(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"compare", tiny_scene(), "-o", path("dir"), "--runs", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  [[nodiscard]] json metrics() const { return json::parse(read("dir/metrics.json")); }
};

TEST_F(Compare, OnTheSameSamplesPairsAreCounted) {
  const Outcome outcome =
      compare({"--methods", "view-sample", "--reference-samples", "same", "--bits", "--png", "--light-samples", "64"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("view-sample"));
  for (const char* name : {"metrics.json", "report.html", "view-sample.exr", "view-sample-error.png",
                           "view-sample.bits", "view-sample.png", "reference.exr", "reference.bits"}) {
    EXPECT_TRUE(std::filesystem::exists(path("dir") + "/" + name)) << name;
  }
  const json result = metrics();
  EXPECT_EQ(result.at("reference").at("method"), "raytrace");
  ASSERT_EQ(result.at("methods").size(), 1u);
  const json& method = result["methods"][0];
  for (const char* key : {"mean", "rmse", "p999", "max", "over05", "bias"})
    EXPECT_TRUE(method.at("error").contains(key)) << key;
  const json& seconds = method.at("seconds");
  EXPECT_TRUE(seconds.at("warmup").is_number());
  double sum = 0;
  for (const char* phase : {"load", "mesh", "view", "light", "evaluate"}) sum += seconds.at(phase).get<double>();
  EXPECT_DOUBLE_EQ(seconds.at("total").get<double>(), sum);

  // Computes the counts again from the files.
  const auto mine = tests::read_bits(path("dir/view-sample.bits")),
             other = tests::read_bits(path("dir/reference.bits"));
  std::uint64_t all = 0, penumbra = 0, differing = 0;
  for (std::size_t i = 0; i < mine.p.size(); ++i) {
    if (mine.triangle[i] < 0) continue;
    std::uint32_t a = 0, b = 0, ab = 0;
    for (std::size_t word = 2 * i; word < 2 * i + 2; ++word) {
      a += static_cast<std::uint32_t>(std::popcount(mine.masks[word]));
      b += static_cast<std::uint32_t>(std::popcount(other.masks[word]));
      ab += static_cast<std::uint32_t>(std::popcount(mine.masks[word] ^ other.masks[word]));
    }
    all += 64;
    if ((a > 0 && a < 64) || (b > 0 && b < 64)) penumbra += 64;
    differing += ab;
  }
  EXPECT_EQ(method.at("pairsAll"), all);
  EXPECT_EQ(method.at("pairs"), penumbra);
  EXPECT_EQ(method.at("pairsDiffering"), differing);
  EXPECT_GT(penumbra, 0u);
  EXPECT_EQ(method.at("counters").at("exactDecided"), differing);
  EXPECT_EQ(method["counters"].at("methodRight").get<std::uint64_t>() +
                method["counters"].at("referenceRight").get<std::uint64_t>(),
            differing);
}

/// A method that gives areas on request has no pairs, whatever the table of methods says about it, but it has an error.
TEST_F(Compare, ExactRowsAreAreasAndHaveErrorsButNoPairs) {
  const Outcome outcome =
      compare({"--methods", "edge-scatter:rows=exact,edge-scatter,edge-scatter:rows=exact", "--bits", "--reference",
               "raytrace", "--reference-samples", "same", "--max-rmse", "0.2"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json methods = metrics().at("methods");
  ASSERT_EQ(methods.size(), 3u);
  for (const std::size_t i : {0u, 2u}) {
    EXPECT_GT(methods[i].at("error").at("rmse"), 0);
    for (const char* key : {"pairs", "pairsAll", "pairsDiffering", "pairsDecided"}) {
      EXPECT_TRUE(methods[i].at(key).is_null()) << key;
    }
  }
  EXPECT_EQ(methods[0].at("error"), methods[2].at("error"));
  EXPECT_EQ(methods[1].at("pairsDiffering"), 0);
  EXPECT_FALSE(std::filesystem::exists(path("dir/edge-scatter,rows=exact.bits")));
  EXPECT_TRUE(std::filesystem::exists(path("dir/edge-scatter.bits")));
  EXPECT_EQ(read_exr(path("dir/edge-scatter,rows=exact.exr")).attributes.at("penumbra.output"), "radiance");
  // Impossible requests are refused before the reference is traced.
  const Outcome bits = run({"render", path("scene.json"), "-o", path("a.exr"), "--method", "edge-scatter",
                            "--method-option", "rows=exact", "--bits", path("a.bits")});
  EXPECT_EQ(bits.code, 2) << bits.err;
}

/// A method that fails does not affect the others, and the command ends with that method's exit code.
TEST_F(Compare, AMethodThatFailsIsReportedAndTheOthersGoOn) {
  // Files of an earlier run must not stay next to the new report; other files stay.
  std::filesystem::create_directories(path("dir"));
  for (const char* ending : {".exr", "-error.png", ".png"})
    write("dir/edge-scatter,engine=vulkan" + std::string(ending), "old");
  const Outcome outcome = compare({"--methods", "edge-scatter:engine=vulkan,view-sample,depth-complexity",
                                   "--light-samples", "2x2048", "--reference-samples", "same", "--max-rmse", "1"});
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("edge-scatter:engine=vulkan: "));
  EXPECT_THAT(outcome.out, HasSubstr("failed"));
  const json methods = metrics().at("methods");
  ASSERT_EQ(methods.size(), 3u);
  EXPECT_EQ(methods[0].at("failure").at("exitCode"), 3);
  EXPECT_THAT(methods[0].at("failure").at("message").get<std::string>(), HasSubstr("2048"));
  EXPECT_TRUE(methods[0].at("error").is_null());
  EXPECT_TRUE(methods[0].at("seconds").at("shadow").is_null());
  for (const std::size_t i : {1u, 2u}) {
    EXPECT_TRUE(methods[i].at("failure").is_null());
    EXPECT_EQ(methods[i].at("pairsDiffering"), 0);
  }
  EXPECT_FALSE(std::filesystem::exists(path("dir/edge-scatter,engine=vulkan.exr")));
  EXPECT_FALSE(std::filesystem::exists(path("dir/edge-scatter,engine=vulkan-error.png")));
  EXPECT_TRUE(std::filesystem::exists(path("dir/edge-scatter,engine=vulkan.png"))) << "--png was not asked for";
  EXPECT_TRUE(std::filesystem::exists(path("dir/view-sample.exr")));
  EXPECT_EQ(report_json(read("dir/report.html")).at("metrics").at("methods").at(0).at("failure"),
            methods[0].at("failure"));
}

TEST_F(Compare, AFileThatCannotBeWrittenIsSaidBeforeAnythingIsDone) {
  std::filesystem::create_directories(path("dir/edge-scatter.exr"));  // a folder where the picture should be
  const Outcome outcome = compare({"--methods", "edge-scatter,view-sample", "--light-samples", "16"});
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_THAT(outcome.err, testing::HasSubstr("edge-scatter.exr"));
  EXPECT_FALSE(std::filesystem::exists(path("dir/view-sample.exr")));
  EXPECT_FALSE(std::filesystem::exists(path("dir/metrics.json")));
}

TEST_F(Compare, ARefusalLeavesNoFolders) {
  std::filesystem::create_directories(path("kept"));
  const std::string folder = path("kept") + "/new/inner";
  EXPECT_EQ(run({"compare", path("nothing.json"), "-o", folder}).code, 3);
  EXPECT_EQ(run({"compare", tiny_scene(), "-o", folder, "--methods", "edge-scatter:rows=never"}).code, 2);
  EXPECT_TRUE(std::filesystem::is_empty(path("kept")));
}

/// If too many pairs differ to decide each one, an evenly spaced sample of them is decided, and metrics.json gives the
/// sample's size.
TEST_F(Compare, VerdictsAreGivenBySamplingWhereTooManyPairsDiffer) {
  const Outcome outcome = compare({"--methods", "accumulate:size=8,raytrace", "--light-samples", "64",
                                   "--reference-samples", "same", "--size", "96x64"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json result = metrics();
  const json& method = result.at("methods").at(0);
  const auto count = [&](const char* key) { return method.at(key).get<std::uint64_t>(); };
  ASSERT_GT(count("pairsDiffering"), 4000u) << "a map of 8 texels is coarse";
  EXPECT_LE(count("pairsDecided"), 4000u);
  EXPECT_GE(count("pairsDecided"), 2000u);
  EXPECT_DOUBLE_EQ(method.at("pairsDecidedShare").get<double>(),
                   static_cast<double>(count("pairsDecided")) / static_cast<double>(count("pairsDiffering")));
  EXPECT_EQ(count("pairsMethodRight") + count("pairsReferenceRight"), count("pairsDecided"));
  EXPECT_GT(count("pairsReferenceRight"), 0.99 * static_cast<double>(count("pairsDecided")));
  EXPECT_EQ(result.at("methods").at(1).at("pairsDecidedShare"), 1);
}

TEST_F(Compare, ErrorsCanBeRecomputedFromTheImages) {
  const Outcome outcome = compare({"--methods", "raytrace", "--reference-samples", "1024", "--light-samples", "16"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json result = metrics();
  const json& method = result.at("methods").at(0);
  EXPECT_TRUE(method.at("pairsDiffering").is_null()) << "not the same samples";
  EXPECT_EQ(result["reference"]["lightSamples"], 1024);
  const ExrFile mine = read_exr(path("dir/raytrace.exr")), other = read_exr(path("dir/reference.exr"));
  // No surface of this scene is an emitter. Some pixels of the wedge are at the horizon, so the wedge is left out.
  double largest = 0;
  for (std::size_t i = 0; i < mine.floats.at("V").size(); ++i) {
    if (mine.integers.at("id")[i] > 1) continue;
    largest = std::max(largest, std::abs(double{mine.floats.at("V")[i]} - double{other.floats.at("V")[i]}));
  }
  EXPECT_GT(largest, 0.005);
  EXPECT_GE(method.at("error").at("max").get<double>(), largest - 1e-6);
  EXPECT_LT(method["error"]["rmse"].get<double>(), 0.06);
  EXPECT_GT(method["error"]["rmse"].get<double>(), 0);
}

/// Errors are given for each light and for all together; here for one pixel, whose V is read from the pictures.
TEST_F(Compare, EveryLightIsJudged) {
  write("two.json", scene_text_with("/lights/1", R"({"name": "rim", "disk": {"center": [2, 4, 1],
      "normal": [-0.3, -1, 0], "radius": 0.6}})"));
  const Outcome outcome = run({"compare", path("two.json"), "-o", path("dir"), "--runs", "1", "--methods",
                               "view-sample,pcss", "--light-samples", "64", "--sample-pixels", "20,24"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json result = metrics();
  const ExrFile truth = read_exr(path("dir/reference.exr"));
  constexpr std::size_t kPixel = 24 * 48 + 20;
  for (const json& method : result.at("methods")) {
    ASSERT_EQ(method.at("lights").size(), 2u);
    const ExrFile mine = read_exr(path("dir/" + method["entry"].get<std::string>() + ".exr"));
    std::vector<double> errors;
    for (const json& light : method["lights"]) {
      const std::string channel = light.at("name").get<std::string>() + ".V";
      ASSERT_EQ(light.at("judgedPixels"), 1) << channel;
      errors.push_back(double{mine.floats.at(channel)[kPixel]} - double{truth.floats.at(channel)[kPixel]});
      EXPECT_EQ(light.at("error").at("bias"), errors.back()) << channel;
    }
    EXPECT_EQ(method["lights"][0]["error"], method.at("error")) << "the first light's stay where they were";
    EXPECT_EQ(method.at("errorAllLights").at("max"), std::max(std::abs(errors[0]), std::abs(errors[1])));
    EXPECT_EQ(method["errorAllLights"]["bias"], (errors[0] + errors[1]) / 2);
  }
}

/// By default the report shows what a method with masks does wrong, separately from the error due to the number of
/// light samples.
TEST_F(Compare, ExactnessIsShownWhateverTheReferenceIs) {
  ASSERT_EQ(compare({"--methods", "view-sample,pcss", "--light-samples", "64"}).code, 0);
  const json result = metrics();
  const json &exact = result.at("methods").at(0), &scalar = result.at("methods").at(1);
  EXPECT_TRUE(exact.at("pairs").is_null()) << "the reference has other light samples";
  const json& same = exact.at("lights").at(0).at("sameSamples");
  EXPECT_EQ(same.at("pairsDiffering"), 0);
  EXPECT_GT(same.at("pairs"), 0);
  EXPECT_EQ(same.at("error").at("max"), 0);
  EXPECT_GT(exact.at("error").at("max"), 0);
  EXPECT_TRUE(scalar.at("lights").at(0).at("sameSamples").is_null());
  // So the whole error comes from having only 64 light samples.
  EXPECT_EQ(result.at("sameSamples").at("method"), "raytrace");
  EXPECT_EQ(result["sameSamples"]["lightSamples"], 64);
  EXPECT_EQ(result["sameSamples"]["lights"][0]["error"], exact["error"]);
}

TEST_F(Compare, MaxRmseDecidesTheExitCode) {
  EXPECT_EQ(compare({"--methods", "raytrace", "--light-samples", "16", "--max-rmse", "0.5"}).code, 0);
  const Outcome strict = compare({"--methods", "raytrace", "--light-samples", "16", "--max-rmse", "0.0000001"});
  EXPECT_EQ(strict.code, 1);
  EXPECT_THAT(strict.err, HasSubstr("--max-rmse"));
  EXPECT_TRUE(std::filesystem::exists(path("dir/report.html"))) << "the job ran; only the check failed";
}

TEST_F(Compare, OneMethodMayAppearSeveralTimes) {
  ASSERT_EQ(compare({"--methods", "raytrace,raytrace", "--light-samples", "4", "--reference-samples", "same"}).code, 0);
  const json result = metrics();
  ASSERT_EQ(result.at("methods").size(), 2u);
  EXPECT_NE(result["methods"][0].at("entry"), result["methods"][1].at("entry"));
  EXPECT_TRUE(std::filesystem::exists(path("dir/raytrace-2.exr")));
  for (const json& method : result["methods"]) EXPECT_EQ(method.at("pairsDiffering"), 0);
}

TEST_F(Compare, ErrorsOverChosenPixels) {
  ASSERT_EQ(compare({"--methods", "raytrace", "--light-samples", "4", "--sample-pixels", "5"}).code, 0);
  EXPECT_EQ(metrics().at("judgedPixels"), 5);
  ASSERT_EQ(compare({"--methods", "raytrace", "--light-samples", "4", "--sample-pixels", "0,0"}).code, 0);
  EXPECT_EQ(metrics().at("judgedPixels"), 0) << "the top left corner is background";
  EXPECT_TRUE(metrics().at("methods").at(0).at("error").is_null());
}

TEST_F(Compare, TheExactReferenceEvaluatesChosenPixelsAlone) {
  ASSERT_EQ(compare({"--methods", "view-sample,exact", "--light-samples", "1024", "--reference", "exact",
                     "--sample-pixels", "40"})
                .code,
            0);
  const json result = metrics();
  EXPECT_EQ(result.at("reference").at("method"), "exact");
  EXPECT_EQ(result.at("judgedPixels"), 40);
  EXPECT_TRUE(result.at("methods").at(0).at("pairs").is_null());
  // Two convex occluders and their overlap: three times the bound of tests/unit/exact_method.cpp, at 32 rows.
  EXPECT_LT(result.at("methods").at(0).at("error").at("max"), 3 * 2.0 / 32);
  EXPECT_EQ(result.at("methods").at(1).at("error").at("max"), 0);
  const std::uint64_t evaluated = result.at("reference").at("counters").at("viewSamples");
  EXPECT_GE(evaluated, 40u);  // and pixels at the horizon
  EXPECT_LE(evaluated, 40u + result.at("horizonPixels").get<std::uint64_t>());
  const ExrFile picture = read_exr(path("dir/reference.exr"));
  std::size_t known = 0;
  for (const float v : picture.floats.at("V")) known += std::isnan(v) ? 0 : 1;
  EXPECT_GE(known, evaluated);
  for (const float r : picture.floats.at("R")) EXPECT_TRUE(std::isfinite(r));
}

TEST_F(Compare, DefaultIsEveryGeometryAndImageMethodThatIsNotOnRequest) {
  const Outcome outcome = compare({"--light-samples", "16", "--reference-samples", "64"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::vector<std::string> names, expected;
  const json result = metrics();
  for (const json& method : result.at("methods")) names.push_back(method.at("entry"));
  const json all = json::parse(run({"methods", "--json"}).out);
  const bool is_processor = json::parse(run({"devices", "--json"}).out).at("devices").at(0).at("kind") == "cpu";
  for (const std::string family : {"geometry", "image"}) {
    for (const json& method : all.at("methods")) {
      if (method.at("family") != family || method.at("onRequest") == true) continue;
      if (is_processor && method.at("slowOnProcessors") == true) {
        EXPECT_THAT(outcome.err, HasSubstr(method.at("name").get<std::string>()));
        continue;
      }
      expected.push_back(method.at("name"));
      if (method.at("name") == "edge-scatter") expected.emplace_back("edge-scatter:rows=exact");  // its exactArea
    }
  }
  EXPECT_EQ(names, expected);
  EXPECT_THAT(names, testing::IsSupersetOf({"edge-scatter", "view-sample", "pcss", "packet", "shadow-map"}));
  EXPECT_THAT(names, testing::Not(testing::Contains("bitmask"))) << "it takes minutes at the main job's size";
  EXPECT_EQ(result["methods"][0]["lights"][0]["lightSamples"], 16);
  EXPECT_EQ(result["methods"][1]["lights"][0]["quantity"], "area");
  EXPECT_EQ(result["methods"][1]["lightSamples"], 0);
  // An option that excludes the areas leaves out only them.
  const Outcome vulkan = compare({"--methods", "geometry", "--method-option", "engine=vulkan", "--light-samples", "4",
                                  "--reference-samples", "4"});
  EXPECT_EQ(vulkan.code, 0) << vulkan.err;
  EXPECT_THAT(vulkan.err, HasSubstr("edge-scatter:rows=exact is left out"));
  EXPECT_EQ(metrics().at("methods").at(0).at("entry"), "edge-scatter");
}

TEST_F(Compare, OptionsReachTheMethodsThatHaveThem) {
  const Outcome outcome =
      compare({"--methods", "raytrace,pcss:size=64,pcss", "--method-option", "size=128", "--light-samples", "16"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json methods = metrics().at("methods");
  ASSERT_EQ(methods.size(), 3u);
  EXPECT_TRUE(methods[0].at("options").empty());
  EXPECT_EQ(methods[1].at("options").at("size"), "64");
  EXPECT_EQ(methods[2].at("options").at("size"), "128");
  EXPECT_TRUE(std::filesystem::exists(path("dir/pcss,size=64.exr")));
}

TEST_F(Compare, ReportIsOneFileWithoutNetwork) {
  ASSERT_EQ(compare({"--methods", "raytrace", "--light-samples", "4", "--size", "9x8", "--lenient"}).code, 0);
  const std::string html = read("dir/report.html");
  EXPECT_THAT(html, testing::Not(HasSubstr("src=\"http")));
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  const json report = report_json(read("dir/report.html"));
  EXPECT_EQ(report.at("metrics"), json::parse(read("dir/metrics.json")));
  EXPECT_EQ(report.at("view"), "view " + tiny_scene() + " --size 9x8 --lenient");
}

TEST_F(Compare, GroupsLeaveOutWhatCannotDoTheLight) {
  write("bulb.json",
        scene_text_with("/lights/0", R"({"name": "bulb", "sphere": {"center": [0, 4, 0], "radius": 0.3}})"));
  const Outcome all = run(
      {"compare", path("bulb.json"), "-o", path("dir"), "--runs", "1", "--methods", "all", "--light-samples", "16"});
  EXPECT_EQ(all.code, 0) << all.err;
  EXPECT_THAT(all.err, HasSubstr("view-sample-planar is left out"));
  EXPECT_THAT(all.err, HasSubstr("left out: image-based methods replace a sphere by up to 54 disks"));
  const Outcome image = run(
      {"compare", path("bulb.json"), "-o", path("dir"), "--runs", "1", "--methods", "pcss:size=64", "--size", "8x8"});
  EXPECT_EQ(image.code, 0) << image.err;
  const Outcome named =
      run({"compare", path("bulb.json"), "-o", path("dir"), "--runs", "1", "--methods", "view-sample-planar"});
  EXPECT_EQ(named.code, 3);
  EXPECT_THAT(named.err, HasSubstr("bulb"));
}

}  // namespace
}  // namespace penumbra::tests
