// SPDX-License-Identifier: Apache-2.0
#include "compare/machine.hpp"
#include "compare/stats.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace penumbra::compare {
namespace {

std::vector<std::string> keys_of(const nlohmann::ordered_json& json) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  return keys;
}

Stats some_stats() {
  Stats stats;
  stats.scene = "bunny.json";
  stats.width = 640;
  stats.height = 480;
  stats.device = "llvmpipe";
  stats.triangles = 69666;
  stats.method = "pcss";
  stats.options = {{"search", "16"}, {"bias", "auto"}};
  stats.light_samples = 256;
  stats.sample_pattern = "rows";
  stats.seconds = {.load = 0.5,
                   .mesh = 0.25,
                   .view = {},
                   .light = 0.125,
                   .evaluate = 1.0,
                   .beauty = {},
                   .write = {},
                   .warmup = {},
                   .total = 3.0};
  stats.passes = {{"filter", 12.5}, {"blockers", 3.0}};
  stats.peak_memory_bytes = 1ull << 40;
  stats.memory = {{"method", 1ull << 40}, {"scene", 12}};
  stats.counters = {{"texels", 1234567890123ull}};
  stats.warnings = {"a \"warning\""};
  return stats;
}

TEST(Seconds, AddUpToTheirPhases) {
  Seconds seconds;
  EXPECT_EQ(seconds.sum(), 0);
  seconds.load = 1, seconds.mesh = 2, seconds.view = 4, seconds.light = 8, seconds.evaluate = 16;
  seconds.warmup = 1000, seconds.total = 1000;
  EXPECT_EQ(seconds.sum(), 31) << "times that were not measured count as 0";
  seconds.beauty = 32, seconds.write = 64;
  EXPECT_EQ(seconds.sum(), 127);
}

TEST(StatsJson, HasTheNamesOfTheInterface) {
  const auto json = to_json(some_stats());
  EXPECT_EQ(keys_of(json), (std::vector<std::string>{"scene", "size", "device", "triangles", "method", "options",
                                                     "lightSamples", "samplePattern", "runs", "seconds", "passes",
                                                     "peakMemoryBytes", "memory", "counters", "warnings", "lights"}));
  EXPECT_EQ(json["size"], nlohmann::ordered_json::array({640, 480}));
  EXPECT_EQ(json["options"]["search"], "16");
  EXPECT_EQ(keys_of(json["seconds"]), (std::vector<std::string>{"load", "mesh", "view", "light", "evaluate", "shadow",
                                                                "beauty", "write", "warmup", "total"}));
  EXPECT_EQ(json["seconds"]["shadow"], 1.125);
  EXPECT_TRUE(json["seconds"]["view"].is_null());
  EXPECT_EQ(json["passes"][0]["name"], "filter");
  EXPECT_EQ(json["passes"][1]["milliseconds"], 3.0);
  EXPECT_EQ(json["peakMemoryBytes"], 1099511627776ull);
  EXPECT_EQ(json["memory"]["method"], 1099511627776ull);
  EXPECT_EQ(json["memory"]["scene"], 12);
  EXPECT_EQ(json["counters"]["texels"], 1234567890123ull);
  EXPECT_EQ(json["warnings"][0], "a \"warning\"");
}

TEST(StatsJson, EmptyIsEmptyNotNull) {
  const auto json = to_json(Stats{});
  EXPECT_EQ(json["options"].dump(), "{}");
  EXPECT_EQ(json["counters"].dump(), "{}");
  EXPECT_EQ(json["passes"].dump(), "[]");
  EXPECT_EQ(json["warnings"].dump(), "[]");
  EXPECT_EQ(json["lights"].dump(), "[]");
  EXPECT_TRUE(json["seconds"]["shadow"].is_null());
}

TEST(StatsJson, SaysOfEachLightWhetherItWasMeasuredOrCounted) {
  Stats stats = some_stats();
  stats.lights = {{.name = "key", .method = "edge-scatter", .options = {{"rows", "exact"}}, .area = true, .light = 0.5},
                  {.name = "rim",
                   .method = "raytrace",
                   .light_samples = 64,
                   .sample_pattern = "sobol",
                   .light = 0.25,
                   .evaluate = 0.5}};
  const auto lights = to_json(stats)["lights"];
  ASSERT_EQ(lights.size(), 2U);
  EXPECT_EQ(keys_of(lights[0]), (std::vector<std::string>{"name", "method", "options", "lightSamples", "samplePattern",
                                                          "quantity", "seconds"}));
  EXPECT_EQ(lights[0]["quantity"], "area");
  EXPECT_EQ(lights[0]["lightSamples"], 0);
  EXPECT_TRUE(lights[0]["samplePattern"].is_null());
  EXPECT_EQ(lights[0]["options"]["rows"], "exact");
  EXPECT_TRUE(lights[0]["seconds"]["shadow"].is_null());
  EXPECT_EQ(lights[1]["quantity"], "count");
  EXPECT_EQ(lights[1]["lightSamples"], 64);
  EXPECT_EQ(lights[1]["samplePattern"], "sobol");
  EXPECT_EQ(lights[1]["options"].dump(), "{}");
  EXPECT_EQ(lights[1]["seconds"]["shadow"], 0.75);
}

TEST(MetricsJson, HasTheNamesOfTheInterface) {
  Metrics metrics;
  metrics.reference = some_stats();
  metrics.judged_pixels = 1000;
  metrics.horizon_pixels = 7;
  MethodResult result;
  result.entry = "pcss:search=16";
  result.stats = some_stats();
  result.error = VisibilityError{0.1, 0.2, 0.3, 0.4, 0.5, -0.6};
  result.pairs = PairCounts{400, 300, 2};
  result.beauty_error = BeautyError{0.25, -0.125};
  MethodResult sampled = result;
  sampled.verdicts = PairVerdicts{.decided = 1, .method_right = 1, .reference_right = 0, .zero_predicate = 1};
  MethodResult failed;
  failed.failure = MethodFailure{4, "out of memory"};
  metrics.methods = {result, MethodResult{}, sampled, failed};
  const auto json = to_json(metrics);
  EXPECT_EQ(keys_of(json), (std::vector<std::string>{"reference", "judgedPixels", "horizonPixels", "sameSamples",
                                                     "methods", "leftOut"}));
  EXPECT_TRUE(json["sameSamples"].is_null()) << "the reference already used the methods' light samples";
  EXPECT_EQ(json["reference"]["method"], "pcss");
  const auto& first = json["methods"][0];
  EXPECT_EQ(first["method"], "pcss");
  EXPECT_EQ(first["seconds"]["evaluate"], 1.0);
  EXPECT_EQ(keys_of(first["error"]), (std::vector<std::string>{"mean", "rmse", "p999", "max", "over05", "bias"}));
  EXPECT_EQ(first["error"]["bias"], -0.6);
  EXPECT_EQ(keys_of(first["beautyError"]), (std::vector<std::string>{"relativeRmse", "relativeBias"}));
  EXPECT_EQ(first["beautyError"]["relativeRmse"], 0.25);
  EXPECT_EQ(first["pairs"], 300);
  EXPECT_EQ(first["pairsAll"], 400);
  EXPECT_EQ(first["pairsDiffering"], 2);
  EXPECT_TRUE(first["pairsZeroPredicate"].is_null()) << "null: this reference decides no pair exactly";
  const auto& second = json["methods"][1];
  for (const char* key : {"error", "beautyError", "pairs", "pairsAll", "pairsDiffering", "pairsZeroPredicate"}) {
    EXPECT_TRUE(second.contains(key) && second[key].is_null()) << key;
  }
  EXPECT_TRUE(second.at("failure").is_null());
  const auto& third = json["methods"][2];
  EXPECT_EQ(third["pairsDecided"], 1);
  EXPECT_EQ(third["pairsDecidedShare"], 0.5);
  EXPECT_EQ(third["pairsMethodRight"], 1);
  EXPECT_EQ(third["pairsReferenceRight"], 0);
  EXPECT_EQ(third["pairsZeroPredicate"], 1);
  const auto& fourth = json["methods"][3];
  EXPECT_EQ(fourth["failure"]["exitCode"], 4);
  EXPECT_EQ(fourth["failure"]["message"], "out of memory");
  EXPECT_TRUE(fourth["error"].is_null() && fourth["seconds"]["shadow"].is_null());
}

TEST(MetricsJson, SaysHowErrorsLookAndWhatSeparationCosts) {
  Metrics metrics;
  MethodResult result;
  result.beauty_error = BeautyError{0.25, 0};
  result.separation = Separation{{0.125, 0.0625}, {0.5, -0.5}};
  result.flip = Flip{0.0625, 0.5};
  result.pops = Pops{0.75, 0.875};
  LightResult light;
  light.eye = EyeError{0.5, {}};
  light.by_width = {{0, 4, 7, VisibilityError{.rmse = 0.5, .max = 0.75, .bias = -0.25}},
                    {4, std::numeric_limits<double>::infinity(), 0, {}}};
  result.lights = {light};
  metrics.methods = {result, MethodResult{}};
  const auto json = to_json(metrics)["methods"];
  EXPECT_EQ(json[0]["separation"],
            (nlohmann::ordered_json{{"alone", {{"relativeRmse", 0.125}, {"relativeBias", 0.0625}}},
                                    {"ofV", {{"relativeRmse", 0.5}, {"relativeBias", -0.5}}},
                                    {"change", 0.25}}));
  EXPECT_EQ(json[0]["eye"].dump(), R"({"over255":0.5,"banding":null,"flip":{"mean":0.0625,"max":0.5}})");
  EXPECT_EQ(json[0]["lights"][0]["eye"].dump(), R"({"over255":0.5,"banding":null})");
  EXPECT_EQ(json[0]["pops"].dump(), R"({"share":0.75,"max":0.875})");
  EXPECT_EQ(json[0]["penumbraWidth"]["pixels"].dump(),
            R"([{"from":0.0,"to":4.0,"pixels":7,"rmse":0.5,"bias":-0.25,"max":0.75},)"
            R"({"from":4.0,"to":null,"pixels":0,"rmse":null,"bias":null,"max":null}])");
  EXPECT_TRUE(json[0]["penumbraWidth"]["texels"].is_null());
  EXPECT_TRUE(json[0]["contactDistance"]["pixels"].is_null());
  EXPECT_TRUE(json[1]["separation"].is_null());
  EXPECT_FALSE(json[1].contains("pops"));
}

/// Judges every light, and compares a method's masks with rays on its own light samples, whatever the reference is.
TEST(MetricsJson, JudgesEachLight) {
  Metrics metrics;
  metrics.same_samples = SampleCost{some_stats(), {{"key", 10, 1, VisibilityError{.rmse = 0.0625}, {}, {}}}, {}};
  MethodResult result;
  result.all_lights_error = VisibilityError{.rmse = 0.5};
  result.lights = {{"key", 10, 1, VisibilityError{.rmse = 0.25}, VisibilityError{.rmse = 0.75}, {}},
                   {"rim", 20, 2, {}, {}, SameSamples{VisibilityError{.rmse = 0.125}, {400, 300, 2}, {1, 1, 0, 1}}}};
  metrics.methods = {result};
  const auto json = to_json(metrics);
  EXPECT_EQ(json["sameSamples"]["method"], "pcss");
  EXPECT_EQ(json["sameSamples"]["lights"][0]["error"]["rmse"], 0.0625);
  const auto& method = json["methods"][0];
  EXPECT_EQ(method["errorAllLights"]["rmse"], 0.5);
  EXPECT_TRUE(method["pairs"].is_null()) << "null: the reference used other light samples";
  ASSERT_EQ(method["lights"].size(), 2u);
  EXPECT_EQ(keys_of(method["lights"][0]),
            (std::vector<std::string>{"name", "judgedPixels", "horizonPixels", "error", "horizonError", "classes",
                                      "penumbraWidth", "contactDistance", "eye", "sameSamples", "errorBudget",
                                      "errorBudgetRuns"}));
  EXPECT_TRUE(method["lights"][0]["classes"].is_null());
  EXPECT_EQ(method["lights"][0]["horizonError"]["rmse"], 0.75);
  EXPECT_TRUE(method["lights"][0]["sameSamples"].is_null());
  metrics.methods[0].lights[0].classes = {{"lit", 7, VisibilityError{.rmse = 0.5, .max = 0.75, .bias = -0.25}},
                                          {"self", 0, {}}};
  const auto classes = to_json(metrics)["methods"][0]["lights"][0]["classes"];
  EXPECT_EQ(classes, (nlohmann::ordered_json{
                         {"lit", {{"pixels", 7}, {"rmse", 0.5}, {"bias", -0.25}, {"max", 0.75}}},
                         {"self", {{"pixels", 0}, {"rmse", nullptr}, {"bias", nullptr}, {"max", nullptr}}}}));
  metrics.methods[0].stats.lights = {{.name = "key", .method = "exact", .area = true},
                                     {.name = "rim", .method = "pcss"}};
  const auto asked = to_json(metrics)["methods"][0]["lights"];
  EXPECT_EQ(keys_of(asked[1]), (std::vector<std::string>{
                                   "name", "method", "options", "lightSamples", "samplePattern", "quantity", "seconds",
                                   "judgedPixels", "horizonPixels", "error", "horizonError", "classes", "penumbraWidth",
                                   "contactDistance", "eye", "sameSamples", "errorBudget", "errorBudgetRuns"}));
  EXPECT_EQ(asked[0]["quantity"], "area");
  EXPECT_EQ(asked[1]["judgedPixels"], 20);
  const auto& same = method["lights"][1]["sameSamples"];
  EXPECT_EQ(keys_of(same), (std::vector<std::string>{"error", "pairs", "pairsAll", "pairsDiffering", "pairsDecided",
                                                     "pairsDecidedShare", "pairsZeroPredicate", "pairsMethodRight",
                                                     "pairsReferenceRight"}));
  EXPECT_EQ(same["error"]["rmse"], 0.125);
  EXPECT_EQ(same["pairsDiffering"], 2);
  EXPECT_EQ(same["pairsDecidedShare"], 0.5);
}

TEST(JsonText, SurvivesBytesThatAreNoUtf8) {
  Stats stats;
  stats.scene = "bad\xff.json";
  const std::string text = json_text(to_json(stats));
  EXPECT_EQ(text.back(), '\n');
  EXPECT_EQ(nlohmann::json::parse(text)["scene"], "bad\xef\xbf\xbd.json");
}

TEST(MachineTest, KnowsWhereItRuns) {
  const Machine machine = this_machine();
  EXPECT_GE(machine.threads, 1u);
  EXPECT_GT(machine.memory_bytes, 1u << 20);
  EXPECT_NE(machine.operating_system.find("Linux"), std::string::npos) << machine.operating_system;
}

}  // namespace
}  // namespace penumbra::compare
