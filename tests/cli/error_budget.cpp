// SPDX-License-Identifier: Apache-2.0
// Tests `compare --error-budget` on scenes with one cause of error each: the budget must name that cause, with its
// sign. The scenes have a floor that casts nothing, casters that receive nothing, and a light at height 5; exact areas
// judge.
#include "base/image.hpp"
#include "base/png.hpp"
#include "tests/cli/program.hpp"
#include "tests/report_json.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr const char* kCauses[] = {"resolution", "view", "layers", "fusion", "gaps", "bias", "samples", "falloff"};

class ErrorBudget : public ProgramTest {
 protected:
  /// `casters`: members of "meshes", each after a comma.
  [[nodiscard]] std::string scene_with(const std::string& casters, double light_half = 0.6) const {
    const std::string half = std::to_string(light_half);
    return write("scene.json", R"({"format": "penumbra-scene/1", "size": [20, 16],
      "camera": {"eye": [0.1, 0.9, 4.5], "target": [0, 0, 0], "verticalFov": 40},
      "meshes": [{"name": "floor", "castsShadow": false,
                  "quad": {"center": [0, 0, 0], "halfU": [1.5, 0, 0], "halfV": [0, 0, -1.5]}})" +
                                   casters + R"(],
      "lights": [{"name": "key", "rectangle": {"center": [0, 5, 0], "halfU": [)" +
                                   half + R"(, 0, 0], "halfV": [0, 0, )" + half + "]}}]}")
        .string();
  }
  /// A rectangular caster.
  static std::string plate(const std::string& center, const std::string& u, const std::string& v) {
    return R"(, {"name": "plate )" + center + R"(", "receivesShadow": false, "quad": {"center": [)" + center +
           R"(], "halfU": [)" + u + R"(], "halfV": [)" + v + "]}}";
  }

  Outcome compare(const std::string& scene, const std::string& methods, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"compare",     scene,   "-o",        path("dir"), "--runs",        "1",
                                          "--reference", "exact", "--methods", methods,     "--error-budget"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  /// Returns the first method's numbers.
  [[nodiscard]] json explain(const std::string& scene, const std::string& method) const {
    const Outcome outcome = compare(scene, method, {"--sample-pixels", "40"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    json result = json::parse(read("dir/metrics.json")).at("methods").at(0);
    EXPECT_EQ(result.at("errorBudgetRuns").at("rmse"), result.at("error").at("rmse"));
    for (const auto& [key, value] : result.at("errorBudget").items())
      RecordProperty(key, value.is_null() ? "null" : value.dump());
    RecordProperty("rmse", result["error"]["rmse"].dump());
    return result;
  }
  static double number(const json& result, const char* cause) { return result.at("errorBudget").at(cause); }
  /// Tolerance: sums of a few edges in units of 2⁻³² of the light, against doubles; V is stored in float.
  static constexpr double kSums = 1e-6;
  static double rmse(const json& result) { return result.at("error").at("rmse"); }
};

/// Two long strips at different heights. Their shadows on the light overlap as seen from the floor, but not from the
/// light's centre. Each hides less than half of the light, 0.35 · 5 / 3.5 / 1.2 and 0.15 · 5 / 1.5 / 1.2 of its width,
/// so that no sum is cut off: V is too dark by the overlap.
TEST_F(ErrorBudget, WhereShadowsAreAddedTwiceItIsFusion) {
  const json result = explain(scene_with(plate("-0.225, 3.5, 0", "0.175, 0, 0", "0, 0, -3") +
                                         plate("0.125, 1.5, 0", "0.075, 0, 0", "0, 0, -3")),
                              "backproject:size=64");
  EXPECT_LT(result.at("error").at("bias").get<double>(), 0);
  EXPECT_LT(number(result, "fusion"), -0.6 * rmse(result));
  EXPECT_GT(number(result, "resolution"), -0.3 * rmse(result));
  for (const char* cause : {"layers", "gaps", "bias"}) EXPECT_EQ(number(result, cause), 0) << cause;
  // Views from the light's own points count nothing twice: the single view adds what overlaps.
  EXPECT_LT(number(result, "view"), -0.6 * rmse(result));
}

/// A plate that another one hides from the light's centre.
TEST_F(ErrorBudget, WhereACasterIsBehindAnotherItIsLayers) {
  const json result =
      explain(scene_with(plate("0, 3.5, 0", "0.3, 0, 0", "0, 0, -0.3") + plate("0, 1, 0", "0.7, 0, 0", "0, 0, -0.7")),
              "bitmask:occluder=patch:size=64");
  EXPECT_GT(result.at("error").at("bias").get<double>(), 0);
  EXPECT_LT(number(result, "layers"), -0.7 * rmse(result));
  EXPECT_GT(number(result, "resolution"), -0.2 * rmse(result));
  for (const char* cause : {"gaps", "bias"}) EXPECT_EQ(number(result, cause), 0) << cause;
  EXPECT_TRUE(result.at("errorBudget").at("fusion").is_null());
}

/// One plate parallel to the light, in a coarse map.
TEST_F(ErrorBudget, WhereTexelsAreLargeItIsResolution) {
  const json result = explain(scene_with(plate("0.03, 2.5, 0.02", "0.4, 0, 0", "0, 0, -0.4")), "backproject:size=16");
  EXPECT_LT(number(result, "resolution"), -0.5 * rmse(result));
  for (const char* cause : {"layers", "gaps", "bias"}) EXPECT_EQ(number(result, cause), 0) << cause;
  // Bits of 1024 light samples give the same result, up to their own error.
  EXPECT_NEAR(number(result, "fusion"), 0, 0.01);
}

/// A plate that the light's centre sees edge-on is in no layer of any map.
TEST_F(ErrorBudget, WhatTheCentreDoesNotSeeIsView) {
  const json result = explain(scene_with(plate("0, 2.5, 0", "0, 0.8, 0", "0, 0, -0.6"), 1), "backproject:size=64");
  EXPECT_GT(rmse(result), 0.02);
  EXPECT_EQ(result.at("error").at("bias"), result.at("error").at("mean")) << "V is 1 everywhere";
  EXPECT_LT(number(result, "view"), -0.5 * rmse(result));
  for (const char* cause : {"resolution", "layers", "fusion", "gaps", "bias"})
    EXPECT_EQ(number(result, cause), 0) << cause;
  EXPECT_LT(number(result, "remainder"), 0.1 * rmse(result));
  EXPECT_EQ(result.at("errorBudgetRuns").at("allButView").at("rmse"), result["error"]["rmse"]);
}

/// A plate tilted about one axis: each texel has its own depth, and patches leave gaps and overlaps. Bits unite what
/// overlaps, so that the gaps leak; sums are darkened by the overlaps as much as the gaps lighten them.
TEST_F(ErrorBudget, BetweenPatchesOfATiltedPlateAreGaps) {
  const json joined = explain(scene_with(plate("0, 2.5, 0", "0.8, 1.2, 0", "0, 0, -0.9")),
                              "bitmask:occluder=patch:size=32,backproject:size=32:fill=none");
  EXPECT_GT(joined.at("error").at("bias").get<double>(), 0);
  EXPECT_LT(number(joined, "gaps"), -0.4 * rmse(joined));
  EXPECT_GT(number(joined, "resolution"), -0.3 * rmse(joined)) << "gaps do not shrink with the texels";
  for (const char* cause : {"layers", "bias"}) EXPECT_EQ(number(joined, cause), 0) << cause;
  const json added = json::parse(read("dir/metrics.json")).at("methods").at(1);
  EXPECT_GT(number(added, "fusion"), rmse(added)) << "a union has the gaps and not the overlaps";
}

/// A plate so close to the floor that a large bias forgives it.
TEST_F(ErrorBudget, WhereTheShadowIsForgivenItIsBias) {
  const json result = explain(scene_with(plate("0, 0.3, 0", "0.5, 0, 0", "0, 0, -0.5")), "backproject:size=64:bias=20");
  EXPECT_GT(result.at("error").at("bias").get<double>(), 0);
  EXPECT_LT(number(result, "bias"), -0.7 * rmse(result));
  for (const char* cause : {"layers", "gaps"}) EXPECT_EQ(number(result, cause), 0) << cause;
  EXPECT_NEAR(number(result, "fusion"), 0, 0.01);
}

/// Methods of volumes add what two strips hide, which is wrong where the strips overlap as seen from the floor. The
/// strips are parallel to the light, so their silhouettes are right.
TEST_F(ErrorBudget, WhereVolumesAreAddedTwiceItIsFusion) {
  const json result = explain(scene_with(plate("-0.225, 3.5, 0", "0.175, 0, 0", "0, 0, -3") +
                                         plate("0.125, 1.5, 0", "0.075, 0, 0", "0, 0, -3")),
                              "soft-volume,soft-irregular:umbra=layers,soft-volume-blend");
  EXPECT_LT(result.at("error").at("bias").get<double>(), 0);
  // Bits of 1024 light samples have an error of 0.0025 themselves.
  EXPECT_NEAR(number(result, "fusion"), -rmse(result), 0.005);
  EXPECT_NEAR(number(result, "view"), 0, kSums);
  for (const char* cause : {"resolution", "layers", "gaps", "bias", "samples", "falloff"})
    EXPECT_TRUE(result.at("errorBudget").at(cause).is_null()) << cause;
  const json methods = json::parse(read("dir/metrics.json")).at("methods");
  EXPECT_NEAR(rmse(methods.at(1)), rmse(result), kSums) << "by another method";
  EXPECT_NEAR(number(methods.at(1), "fusion"), number(result, "fusion"), kSums);
  EXPECT_NEAR(rmse(methods.at(2)), 0, kSums) << "strips fill their boxes: it knows where they overlap";
}

/// A plate that the light's centre sees edge-on has no silhouettes, hides nothing, and adds nothing.
TEST_F(ErrorBudget, WhatTheCentreSeesEdgeOnIsViewOfVolumes) {
  const json result = explain(scene_with(plate("0, 2.5, 0", "0, 0.8, 0", "0, 0, -0.6"), 1), "soft-volume,plateaus");
  EXPECT_GT(rmse(result), 0.02);
  EXPECT_EQ(result.at("error").at("bias"), result.at("error").at("mean")) << "V is 1 everywhere";
  EXPECT_NEAR(number(result, "view"), -rmse(result), kSums);
  EXPECT_EQ(number(result, "fusion"), 0);
  EXPECT_LT(number(result, "remainder"), 0.005);
  EXPECT_EQ(result.at("errorBudgetRuns").at("allButView").at("rmse"), result["error"]["rmse"]);
  const json hard = json::parse(read("dir/metrics.json")).at("methods").at(1);
  EXPECT_LT(number(hard, "view"), 0);
  EXPECT_TRUE(hard.at("errorBudget").at("fusion").is_null());
}

/// A plate below another: where one plate's outline gives light back, the other plate still hides it.
TEST_F(ErrorBudget, WhereTheMapHasOneLayerItIsLayers) {
  const json result =
      explain(scene_with(plate("0, 3.5, 0", "0.3, 0, 0", "0, 0, -0.3") + plate("0, 1, 0", "0.7, 0, 0", "0, 0, -0.7")),
              "soft-irregular");
  EXPECT_LT(number(result, "layers"), -0.3 * rmse(result));
  EXPECT_NEAR(number(result, "view"), 0, kSums);
  EXPECT_TRUE(result.at("errorBudget").at("fusion").is_null()) << "surfaces that the map does not hold cannot be fused";
  EXPECT_LT(number(result, "remainder"), 0.005);
}

/// One plate: nothing overlaps, and the light's centre sees the same as the floor. The remaining error is the ramp's.
TEST_F(ErrorBudget, WhereARampStandsForAnAreaItIsFalloff) {
  const json result = explain(scene_with(plate("0.03, 2.5, 0.02", "0.4, 0, 0", "0, 0, -0.4")), "wedge-ramp");
  EXPECT_GT(rmse(result), 0.01);
  EXPECT_NEAR(number(result, "falloff"), -rmse(result), kSums);
  EXPECT_TRUE(result.at("errorBudget").at("view").is_number());
}

/// Methods whose every bit is right have only the error of their light samples; hard shadows have only that of their
/// single view.
TEST_F(ErrorBudget, WhereLightSamplesAreFewItIsSamples) {
  const Outcome outcome = compare(scene_with(plate("0.03, 2.5, 0.02", "0.4, 0, 0", "0, 0, -0.4")),
                                  "edge-scatter,hierarchical-penumbra,alias-free,edge-scatter:rows=exact,"
                                  "depth-complexity:variant=forest,accumulate:size=256",
                                  {"--sample-pixels", "40", "--light-samples", "4"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json methods = json::parse(read("dir/metrics.json")).at("methods");
  for (const std::size_t i : {0U, 1U}) {
    EXPECT_GT(rmse(methods.at(i)), 0.02);
    EXPECT_NEAR(number(methods.at(i), "samples"), -rmse(methods.at(i)), kSums);
    EXPECT_TRUE(methods.at(i).at("errorBudget").at("view").is_null());
  }
  EXPECT_NEAR(number(methods.at(2), "view"), -rmse(methods.at(2)), kSums);
  EXPECT_TRUE(methods.at(2).at("errorBudget").at("samples").is_null()) << "it looks from the light's centre";
  EXPECT_TRUE(methods.at(3).at("errorBudget").at("samples").is_null()) << "it has none";
  // The centre's silhouettes are also the floor's, and so have no part in the error of four samples. With 1024 samples
  // in 32 rows, half a row along one side of the plate's shadow is 1 / 64.
  EXPECT_NEAR(number(methods.at(4), "samples"), -rmse(methods.at(4)), 1.0 / 64);
  EXPECT_EQ(number(methods.at(4), "view"), 0);
  EXPECT_LT(number(methods.at(5), "samples"), -0.5 * rmse(methods.at(5))) << "maps of 256 texels are good ones";
}

/// There is no repair if a method has as many light samples as the repair; a table's error has a separate cause; causes
/// that a repair would mix are not separated.
TEST_F(ErrorBudget, SaysWhatOfVolumesCannotBeDone) {
  const Outcome outcome = compare(
      scene_with(plate("0, 2.5, 0", "0.4, 0, 0", "0, 0, -0.4")),
      "soft-volume:coverage=table,soft-volume:as=published,soft-volume:split=2,soft-irregular:umbra=layers:"
      "fusion=union,soft-volume:fusion=product,hard-volume:variant=z-pass,view-sample-planar:lookup=nearest:map=16",
      {"--sample-pixels", "40", "--light-samples", "1024"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json methods = json::parse(read("dir/metrics.json")).at("methods");
  const auto budget = [&](std::size_t i, const char* cause) { return methods.at(i).at("errorBudget").at(cause); };
  const auto words = [&](std::size_t i, const char* cause) {
    return methods.at(i).at("errorBudgetRuns").at(cause).at("words").get<std::string>();
  };
  EXPECT_LT(budget(0, "resolution").get<double>(), 0);
  EXPECT_TRUE(budget(0, "view").is_null());
  EXPECT_THAT(words(0, "view"), HasSubstr("coverage=analytic"));
  EXPECT_THAT(words(1, "fusion"), HasSubstr("as=repaired"));
  const json& parts = methods.at(2).at("errorBudgetRuns").at("view").at("runs").at(0);
  EXPECT_EQ(parts.at("lightParts"), 2) << "parts of its own";
  EXPECT_EQ(parts.at("options").at("silhouettes"), "receiver");
  EXPECT_TRUE(budget(3, "samples").is_null());
  EXPECT_THAT(words(3, "samples"), HasSubstr("1024 light samples"));
  EXPECT_EQ(methods.at(4).at("errorBudgetRuns").at("view").at("runs").at(1).at("lightParts"), 4);
  EXPECT_THAT(words(5, "view"), HasSubstr("z-pass"));
  EXPECT_LT(budget(6, "resolution").get<double>(), 0);
}

TEST_F(ErrorBudget, StandsInMetricsAndReport) {
  const Outcome outcome = compare(tiny_scene(), "edge-scatter,pcss:size=16,bitmask:size=16",
                                  {"--sample-pixels", "40", "--light-samples", "16"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("remainder"));
  const json methods = json::parse(read("dir/metrics.json")).at("methods");
  EXPECT_EQ(methods.at(0).at("errorBudgetRuns").at("samples").at("runs").at(0).at("options").at("rows"), "exact");
  EXPECT_TRUE(methods.at(0).at("errorBudget").at("view").is_null());
  for (const std::size_t i : {0U, 1U, 2U}) {
    const json& budget = methods.at(i).at("errorBudget");
    ASSERT_EQ(budget.size(), 9U);
    const json& runs = methods[i].at("errorBudgetRuns");
    for (const char* cause : kCauses) {
      const json& part = runs.at(cause);
      EXPECT_FALSE(part.at("words").get<std::string>().empty());
      ASSERT_EQ(budget.at(cause).is_null(), part.at("rmse").is_null()) << cause;
      if (budget[cause].is_null()) continue;
      const double now = methods[i].at("error").at("rmse"), then = part.at("rmse");
      EXPECT_EQ(budget[cause].get<double>(), then - now) << cause;
    }
    EXPECT_EQ(budget.at("remainder"), runs.at("together").at("rmse"));
    EXPECT_GE(budget["remainder"].get<double>(), 0);
    if (i == 0) continue;
    EXPECT_EQ(runs.at("resolution").at("runs").at(1).at("options").at("size"), "64");
    EXPECT_EQ(runs.at("view").at("runs").at(0).at("method"), "accumulate");
    EXPECT_EQ(runs.at("allButView").at("options").at("size"), "64");
  }
  EXPECT_TRUE(methods.at(1).at("errorBudget").at("layers").is_null()) << "no form of pcss has layers";
  EXPECT_TRUE(methods.at(2).at("errorBudget").at("layers").is_number());
  const json report = report_json(read("dir/report.html"));
  EXPECT_EQ(report.at("metrics").at("methods"), methods);
  EXPECT_EQ(report.at("methods").at(0).at("repairs").at(0).at(0).at("repaired"), "samples");
  const json& picture = report["methods"].at(2).at("repairs").at(0).at(0);
  EXPECT_EQ(picture.at("repaired"), "resolution");
  EXPECT_TRUE(picture.at("png").get<std::string>().starts_with("data:image/png;base64,"));
}

TEST_F(ErrorBudget, WithoutTheOptionThereIsNone) {
  const Outcome outcome = run({"compare", tiny_scene(), "-o", path("dir"), "--runs", "1", "--methods", "pcss:size=16",
                               "--light-samples", "4", "--reference-samples", "16"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(json::parse(read("dir/metrics.json")).at("methods").at(0).at("errorBudget").is_null());
}

TEST_F(ErrorBudget, IsRefusedWhereThereAreReferencesAlone) {
  const Outcome outcome = compare(tiny_scene(), "raytrace");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("--error-budget"), HasSubstr("penumbra methods")));
  EXPECT_FALSE(std::filesystem::exists(path("dir")));
}

/// A light with a texture has no parts, and texels that are left out have no other form: metrics.json says both.
TEST_F(ErrorBudget, SaysWhatCannotBeDone) {
  Image8 image{2, 1, {{255, 255, 255}, {0, 0, 0}}};
  write_png(path("window.png"), image);
  write("textured.json", scene_text_with("/lights/0", R"({"name": "window", "texture": "window.png",
      "rectangle": {"center": [0, 4, 0], "halfU": [0.6, 0, 0], "halfV": [0, 0, 0.6]}})"));
  const Outcome outcome =
      compare(path("textured.json"), "soft-shadow-map:size=16,backproject-peel:size=16", {"--sample-pixels", "20"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json methods = json::parse(read("dir/metrics.json")).at("methods");
  const json &soft = methods.at(0), &peel = methods.at(1);
  EXPECT_TRUE(soft.at("errorBudget").at("view").is_null());
  EXPECT_THAT(soft.at("errorBudgetRuns").at("view").at("words").get<std::string>(), HasSubstr("texture"));
  EXPECT_EQ(soft["errorBudgetRuns"].at("together").at("lightParts"), 1);
  EXPECT_TRUE(peel.at("errorBudget").at("fusion").is_null());
  EXPECT_THAT(peel.at("errorBudgetRuns").at("fusion").at("words").get<std::string>(), HasSubstr("samples=0"));
  for (const char* part : {"view", "remainder"}) EXPECT_TRUE(peel["errorBudget"].at(part).is_number()) << part;
}

/// Every light has its own budget over its own judged pixels; the first light's is repeated for the method.
TEST_F(ErrorBudget, EachLightIsExplained) {
  const std::filesystem::path one_light = scene_with(plate("0, 2.5, 0", "0.4, 0, 0", "0, 0, -0.4"));
  json scene = json::parse(read(one_light.filename()));
  scene["lights"].push_back(json::parse(R"({"name": "round", "disk": {"center": [0.4, 5, 0],
      "normal": [0, -1, 0], "radius": 0.5}})"));
  const std::string both = write("both.json", scene.dump()).string();
  const Outcome outcome = compare(both, "pcss:size=32,vssm:size=32", {"--sample-pixels", "40"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::AllOf(HasSubstr("Light key:"), HasSubstr("Light round:")));
  const json methods = json::parse(read("dir/metrics.json")).at("methods");
  for (const json& method : methods) {
    const json& lights = method.at("lights");
    ASSERT_EQ(lights.size(), 2U);
    EXPECT_EQ(lights[0].at("errorBudget"), method.at("errorBudget"));
    EXPECT_NE(lights[1].at("errorBudget"), method.at("errorBudget"));
    for (const json& light : lights) {
      EXPECT_EQ(light.at("errorBudgetRuns").at("rmse"), light.at("error").at("rmse"));
      for (const char* part : {"resolution", "view", "bias", "remainder"}) {
        EXPECT_TRUE(light.at("errorBudget").at(part).is_number()) << part << " of " << light.at("name");
      }
    }
  }
  // A light that comes first is explained as it is among others.
  const Outcome first = run({"compare", both, "-o", path("first"), "--runs", "1", "--reference", "exact", "--methods",
                             "pcss:size=32", "--error-budget", "--sample-pixels", "all", "--light", "round"});
  const Outcome among = run({"compare", both, "-o", path("among"), "--runs", "1", "--reference", "exact", "--methods",
                             "pcss:size=32", "--error-budget", "--sample-pixels", "all"});
  ASSERT_EQ(first.code + among.code, 0) << first.err << among.err;
  EXPECT_EQ(json::parse(read("first/metrics.json")).at("methods").at(0).at("errorBudget"),
            json::parse(read("among/metrics.json")).at("methods").at(0).at("lights").at(1).at("errorBudget"));
}

/// If stderr is no terminal, progress is a line every five seconds instead of a bar.
using ErrorBudgetFull = ErrorBudget;
TEST_F(ErrorBudgetFull, SaysHowFarItIs) {
  const Outcome outcome =
      run({"compare", std::string(PENUMBRA_SCENES) + "/bunny.json", "-o", path("dir"), "--runs", "1", "--size",
           "192x192", "--methods", "backproject,contour,shadow-map", "--error-budget"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("penumbra: info: "));
  EXPECT_THAT(outcome.err, HasSubstr("% "));
  EXPECT_THAT(outcome.err, HasSubstr("repaired"));
  EXPECT_THAT(outcome.err, testing::Not(HasSubstr("\r")));
}

}  // namespace
}  // namespace penumbra::tests
