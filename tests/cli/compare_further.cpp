// SPDX-License-Identifier: Apache-2.0
// More tests of `compare`: errors by class of pixel, numbers of runs, methods as reference, and sequences.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class CompareFurther : public ProgramTest {
 protected:
  Outcome compare(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"compare", tiny_scene(), "-o", path("dir"), "--runs", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  [[nodiscard]] json metrics() const { return json::parse(read("dir/metrics.json")); }
};

/// Each judged pixel is lit, in penumbra or in umbra, so the errors of these classes add up to the whole error. Pixels
/// of cast and self shadows are in penumbra or umbra. Here the wedge alone casts, on the floor and on itself.
TEST_F(CompareFurther, ErrorsByClassAddUp) {
  ASSERT_EQ(compare({"--methods", "pcss:size=64", "--reference", "exact"}).code, 0);
  const json all = metrics();
  const json &method = all.at("methods").at(0), &classes = method.at("classes");
  std::uint64_t pixels = 0;
  double squares = 0, sum = 0, largest = 0;
  for (const char* name : {"lit", "penumbra", "umbra"}) {
    const json& one = classes.at(name);
    const auto count = one.at("pixels").get<std::uint64_t>();
    EXPECT_GT(count, 0U) << name;
    pixels += count;
    squares += static_cast<double>(count) * std::pow(one.at("rmse").get<double>(), 2);
    sum += static_cast<double>(count) * one.at("bias").get<double>();
    largest = std::max(largest, one.at("max").get<double>());
  }
  EXPECT_EQ(pixels, all.at("judgedPixels"));
  const auto count = static_cast<double>(pixels);
  EXPECT_NEAR(std::sqrt(squares / count), method.at("error").at("rmse").get<double>(), 1e-12);
  EXPECT_NEAR(sum / count, method.at("error").at("bias").get<double>(), 1e-12);
  EXPECT_EQ(largest, method.at("error").at("max").get<double>());
  const auto pixels_of = [&](const char* name) { return classes.at(name).at("pixels").get<std::uint64_t>(); };
  EXPECT_GT(pixels_of("cast"), 0U);
  EXPECT_LE(std::max(pixels_of("cast"), pixels_of("self")), pixels_of("penumbra") + pixels_of("umbra"));
  EXPECT_EQ(method.at("lights").at(0).at("classes"), classes);
  // The ranges divide the penumbra, and all shadow pixels, where a ray met what hides the light; texels of a map of
  // half the size are twice as wide, except for its border.
  const auto shared = [](const json& ranges) {
    std::uint64_t known = 0;
    double end = 0;
    for (const json& range : ranges) {
      EXPECT_EQ(range.at("from"), end);
      if (!range.at("to").is_null()) end = range.at("to").get<double>();
      known += range.at("pixels").get<std::uint64_t>();
    }
    return known;
  };
  for (const char* unit : {"pixels", "texels"}) {
    const std::uint64_t known = shared(method.at("penumbraWidth").at(unit));
    EXPECT_LE(known, pixels_of("penumbra"));
    EXPECT_GT(known, pixels_of("penumbra") * 9 / 10) << unit;
  }
  EXPECT_GT(shared(method.at("contactDistance").at("pixels")), pixels_of("umbra"));
}

/// Computes the visible errors and the beauty's parts again from the EXRs. A map with a bias as large as the scene
/// gives V = 1 everywhere: its beauty is ∫G.
TEST_F(CompareFurther, EyeAndSeparationAreThoseOfThePictures) {
  ASSERT_EQ(
      compare({"--methods", "pcss:size=64,shadow-map:size=8:bias=1024,edge-scatter", "--reference", "exact"}).code, 0);
  const json all = metrics();
  const json &method = all.at("methods").at(0), &lit = all.at("methods").at(1);
  ASSERT_GT(lit.at("error").at("bias").get<double>(), 0);
  const auto pcss = read_exr(path("dir/pcss,size=64.exr")), truth = read_exr(path("dir/reference.exr")),
             whole = read_exr(path("dir/shadow-map,size=8,bias=1024.exr"));
  std::vector<double> e;
  std::vector<bool> judged, penumbra;
  double shown = 0, count = 0, mean = 0, alone = 0, of_v = 0;
  const auto luminance = [](const auto& exr, std::size_t i) {
    return 0.2126 * exr.floats.at("R")[i] + 0.7152 * exr.floats.at("G")[i] + 0.0722 * exr.floats.at("B")[i];
  };
  for (std::size_t i = 0; i < truth.floats.at("A").size(); ++i) {
    const double v = truth.floats.at("V")[i];
    judged.push_back(truth.floats.at("A")[i] == 1);
    penumbra.push_back(judged[i] && v > 0 && v < 1);
    e.push_back(pcss.floats.at("V")[i] - v);
    if (!judged[i]) continue;
    ASSERT_EQ(whole.floats.at("V")[i], 1) << i;
    count += 1;
    if (std::abs(e[i]) > 1.0 / 255) shown += 1;
    mean += luminance(truth, i);
    alone += std::pow(v * luminance(whole, i) - luminance(truth, i), 2);
    of_v += std::pow(e[i] * luminance(whole, i), 2);
  }
  ASSERT_EQ(count, all.at("judgedPixels").get<double>()) << "no pixel at the horizon here";
  const std::size_t width = truth.width;
  double steps = 0, pairs = 0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    for (const std::size_t next : {i + 1, i + width}) {
      if (next >= e.size() || (next == i + 1 && next % width == 0) || !penumbra[i] || !penumbra[next]) continue;
      steps += std::pow(e[i] - e[next], 2);
      pairs += 1;
    }
  }
  EXPECT_NEAR(method.at("eye").at("over255").get<double>(), shown / count, 1e-12);
  EXPECT_NEAR(method.at("eye").at("banding").get<double>(), std::sqrt(steps / pairs), 1e-7);
  EXPECT_EQ(method.at("lights").at(0).at("eye").at("banding"), method.at("eye").at("banding"));
  EXPECT_GT(method.at("eye").at("flip").at("mean").get<double>(), 0);
  const auto relative = [&](double squares) { return std::sqrt(squares / count) / (mean / count); };
  const json& separation = method.at("separation");
  EXPECT_GT(relative(alone), 1e-4);
  EXPECT_NEAR(separation.at("alone").at("relativeRmse").get<double>(), relative(alone), 1e-6);
  EXPECT_NEAR(separation.at("ofV").at("relativeRmse").get<double>(), relative(of_v), 1e-6);
  EXPECT_EQ(separation.at("change").get<double>(), separation.at("ofV").at("relativeRmse").get<double>() -
                                                       method.at("beautyError").at("relativeRmse").get<double>());
  EXPECT_EQ(lit.at("separation").at("alone"), separation.at("alone"));
  EXPECT_TRUE(all.at("methods").at(2).at("separation").is_null()) << "a mask integrates cosines itself";
}

TEST_F(CompareFurther, RunsAreAsManyAsTwoSecondsHoldOrAsAskedFor) {
  ASSERT_EQ(run({"compare", tiny_scene(), "-o", path("dir"), "--methods", "edge-scatter"}).code, 0);
  EXPECT_EQ(metrics().at("methods").at(0).at("runs"), 5);
  ASSERT_EQ(compare({"--methods", "edge-scatter"}).code, 0);
  EXPECT_EQ(metrics().at("methods").at(0).at("runs"), 1);
}

TEST_F(CompareFurther, AnyMethodWithExactAreasMayJudge) {
  ASSERT_EQ(compare({"--methods", "pcf", "--reference", "exact"}).code, 0);
  const json exact = metrics().at("methods").at(0).at("error");
  ASSERT_EQ(compare({"--methods", "pcf", "--reference", "edge-scatter:rows=exact"}).code, 0);
  const json result = metrics();
  EXPECT_EQ(result.at("reference").at("options").at("rows"), "exact");
  EXPECT_EQ(result.at("reference").at("lightSamples"), 0);
  // Both are exact to the last digits of a float.
  EXPECT_NEAR(result.at("methods").at(0).at("error").at("rmse").get<double>(), exact.at("rmse").get<double>(), 1e-6);
  const Outcome refused = compare({"--methods", "pcf", "--reference", "pcf"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("edge-scatter:rows=exact"));
}

/// Computes the numbers of a sequence again, from V in the EXRs of comparisons of single frames.
TEST_F(CompareFurther, FramesHaveErrorsTogetherAndFlicker) {
  const std::string scene = moving_scene();
  const auto compared = [&](const std::vector<std::string>& when) {
    std::vector<std::string> arguments = {"compare",     scene,       "-o",          path("dir"), "--runs",
                                          "1",           "--methods", "pcf:size=64", "--size",    "40x30",
                                          "--reference", "exact",     "--fps",       "4"};
    arguments.insert(arguments.end(), when.begin(), when.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return metrics();
  };
  std::vector<std::map<std::size_t, double>> errors;  // of judged pixels: here all that show a surface
  std::vector<json> alone;
  double squares = 0, pixels = 0;
  for (const char* frame : {"1", "2", "3"}) {
    alone.push_back(compared({"--frame", frame}));
    const auto method = read_exr(path("dir/pcf,size=64.exr")).floats,
               truth = read_exr(path("dir/reference.exr")).floats;
    std::map<std::size_t, double>& error = errors.emplace_back();
    for (std::size_t i = 0; i < method.at("A").size(); ++i) {
      if (method.at("A")[i] == 1) error[i] = double{method.at("V")[i]} - truth.at("V")[i];
    }
    ASSERT_EQ(error.size(), alone.back().at("judgedPixels"));
    for (const auto& [pixel, e] : error) squares += e * e;
    pixels += static_cast<double>(error.size());
  }
  double changes = 0, common = 0, pops = 0, largest = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    for (const auto& [pixel, e] : errors[i]) {
      const auto next = errors[i + 1].find(pixel);
      if (next == errors[i + 1].end()) continue;
      changes += std::pow(next->second - e, 2);
      largest = std::max(largest, std::abs(next->second - e));
      if (std::abs(next->second - e) > 0.05) pops += 1;
      common += 1;
    }
  }
  const json all = compared({"--frames", "1-3"});
  ASSERT_EQ(all.at("frames").size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const json& frame = all.at("frames").at(i);
    EXPECT_EQ(frame.at("frame"), i + 1);
    EXPECT_EQ(frame.at("methods").at(0).at("rmse"), alone[i].at("methods").at(0).at("error").at("rmse"));
  }
  EXPECT_TRUE(all.at("frames").at(0).at("methods").at(0).at("flicker").is_null());
  const json& method = all.at("methods").at(0);
  EXPECT_EQ(all.at("judgedPixels").get<double>(), pixels);
  EXPECT_NEAR(method.at("error").at("rmse").get<double>(), std::sqrt(squares / pixels), 1e-7);  // V is float32
  EXPECT_GT(changes, 0);
  EXPECT_NEAR(method.at("flicker").get<double>(), std::sqrt(changes / common), 1e-7);
  EXPECT_GT(pops, 0);
  EXPECT_NEAR(method.at("pops").at("share").get<double>(), pops / common, 1e-12);
  EXPECT_NEAR(method.at("pops").at("max").get<double>(), largest, 1e-7);
  EXPECT_GT(all.at("frames").at(1).at("methods").at(0).at("pops").at("max").get<double>(), 0);
  EXPECT_EQ(run({"compare", scene, "-o", path("dir"), "--frames", "3-1"}).code, 2);
  EXPECT_EQ(run({"compare", scene, "-o", path("dir"), "--frames", "1-2", "--error-budget"}).code, 2);
}

}  // namespace
}  // namespace penumbra::tests
