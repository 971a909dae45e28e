// `compare` further on: errors by class of pixel, how often methods run, who may judge, and sequences.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <map>

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

/// Lit, penumbra and umbra share out the judged pixels, so their errors add up to the whole one; cast and self are
/// among the shadowed ones. Here the wedge alone casts, on the floor and on itself.
TEST_F(CompareFurther, ErrorsByClassAddUp) {
  ASSERT_EQ(compare({"--methods", "pcss:size=64", "--reference", "exact"}).code, 0);
  const json all = metrics(), method = all.at("methods").at(0), classes = method.at("classes");
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

/// The sequence's numbers, computed again from comparisons of its frames alone: V of each is in their EXRs.
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
  double changes = 0, common = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    for (const auto& [pixel, e] : errors[i]) {
      const auto next = errors[i + 1].find(pixel);
      if (next == errors[i + 1].end()) continue;
      changes += std::pow(next->second - e, 2);
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
  EXPECT_EQ(run({"compare", scene, "-o", path("dir"), "--frames", "3-1"}).code, 2);
  EXPECT_EQ(run({"compare", scene, "-o", path("dir"), "--frames", "1-2", "--error-budget"}).code, 2);
}

}  // namespace
}  // namespace penumbra::tests
