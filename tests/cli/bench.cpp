// SPDX-License-Identifier: Apache-2.0
// Tests penumbra-bench: JSON lines with stable names. Sizes are tiny, and times are not checked.
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

class Bench : public ProgramTest {
 protected:
  [[nodiscard]] std::vector<json> lines(const std::string& file) const {
    std::istringstream text(read(file));
    std::vector<json> parsed;
    for (std::string line; std::getline(text, line);) parsed.push_back(json::parse(line));
    return parsed;
  }
  /// Runs everything once at 16 × 16 pixels and writes the lines to "lines".
  [[nodiscard]] Outcome run_tiny(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"--scene", tiny_scene(), "--size", "16",
                                          "--runs",  "1",          "--json", path("lines")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

std::vector<std::string> names_of(const std::vector<json>& lines) {
  std::vector<std::string> names;
  for (const json& line : lines) names.push_back(line.at("name"));
  return names;
}

const json& line_of(const std::vector<json>& lines, const std::string& name) {
  const auto found = std::ranges::find_if(lines, [&](const json& line) { return line.at("name") == name; });
  if (found == lines.end()) throw std::runtime_error("no line " + name);
  return *found;
}

TEST_F(Bench, NamesStayAndLinesParse) {
  const Outcome outcome = run_tiny({"--light-half", "0.3", "--light-samples", "64", "--light-samples", "100",
                                    "--reference", "raytrace", "--reference-samples", "5000"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::vector<json> all = lines("lines");
  const std::string few = "scene/half=0.3/size=16/n=64/", many = "scene/half=0.3/size=16/n=100/";
  EXPECT_THAT(names_of(all), ElementsAre(few + "edge-scatter", few + "view-sample", few + "plain-rays",
                                         few + "plain-rays:pattern=jittered", few + "nontrivial-rays", few + "raytrace",
                                         many + "edge-scatter", many + "view-sample", many + "plain-rays",
                                         many + "plain-rays:pattern=jittered", many + "nontrivial-rays",
                                         many + "adaptive-rays", many + "raytrace"));
  for (const json& line : all) {
    for (const char* key : {"commit", "buildType", "device", "triangles", "pixels", "loadBefore", "mesh", "light",
                            "evaluate", "shadow", "ratioToPlainRays", "ratioToNontrivialRays"}) {
      EXPECT_TRUE(line.contains(key)) << line << " " << key;
    }
    EXPECT_EQ(line.at("runs"), 1) << line;
    EXPECT_EQ(line.at("size"), json({16, 16})) << line;
    EXPECT_EQ(line.at("errorToReference").at("reference"), "raytrace at 5000 light samples") << line;
    EXPECT_GT(line.at("errorToReference").at("rmse"), 0) << line;
    EXPECT_EQ(line.contains("error"), line.at("method") != "raytrace") << line;
  }
}

TEST_F(Bench, PeersAskWhatTheySay) {
  ASSERT_EQ(run_tiny({"--light-samples", "256"}).code, 0);
  const std::vector<json> all = lines("lines");
  const auto asked = [&](const std::string& peer) -> std::uint64_t {
    return line_of(all, "scene/size=16/n=256/" + peer).at("viewSamples");
  };
  EXPECT_EQ(asked("plain-rays"), line_of(all, "scene/size=16/n=256/raytrace").at("pixels"));
  EXPECT_GT(asked("adaptive-rays"), 0);
  EXPECT_LE(asked("adaptive-rays"), asked("plain-rays"));
  EXPECT_LE(asked("nontrivial-rays"), asked("plain-rays"));
  // Nontrivial rays know the light samples for which they trace no ray, so their error is at most that of plain rays.
  EXPECT_LE(line_of(all, "scene/size=16/n=256/nontrivial-rays").at("error").at("rmse"),
            line_of(all, "scene/size=16/n=256/plain-rays").at("error").at("rmse"));
}

TEST_F(Bench, OptionsOfMethodsAreInTheirNames) {
  const Outcome outcome = run_tiny({"--method", "raytrace:packet=1", "--method", "exact", "--peer", "none",
                                    "--reference", "exact", "--sample-pixels", "20"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::vector<json> all = lines("lines");
  EXPECT_THAT(names_of(all), ElementsAre("scene/size=16/raytrace:packet=1", "scene/size=16/exact",
                                         "scene/size=16/plain-rays", "scene/size=16/raytrace"));
  EXPECT_EQ(all[0].at("error").at("max"), 0);  // the oracle itself
  EXPECT_EQ(all[0].at("pairsDiffering"), 0);
  EXPECT_FALSE(all[1].contains("pairs"));  // no masks
  EXPECT_EQ(all[1].at("errorToReference").at("max"), 0);
  EXPECT_LE(all[1].at("errorToReference").at("pixels"), 20);
}

TEST_F(Bench, KnotsHaveTheTrianglesAskedFor) {
  ASSERT_EQ(run({"--scene", "knot:600", "--size", "16", "--light-samples", "16", "--method", "view-sample", "--peer",
                 "none", "--runs", "1", "--json", path("lines")})
                .code,
            0);
  EXPECT_EQ(line_of(lines("lines"), "knot-600/size=16/n=16/view-sample").at("triangles"), 602);  // with the floor's 2
}

TEST_F(Bench, PartsOnTheProcessor) {
  const Outcome outcome = run(
      {"--cpu", "--triangles", "600", "--triangles", "6000", "--edges", "500", "--runs", "1", "--json", path("lines")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::vector<json> all = lines("lines");
  EXPECT_THAT(names_of(all), ElementsAre("cpu/edge-graph/triangles=600", "cpu/edge-records/triangles=600",
                                         "cpu/edge-hierarchy/triangles=600", "cpu/edge-graph/triangles=6000",
                                         "cpu/edge-records/triangles=6000", "cpu/edge-hierarchy/triangles=6000",
                                         "cpu/wedges/original/edges=500", "cpu/wedges/tight/edges=500"));
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].contains("growth"), i >= 3 && i < 6) << all[i];
  EXPECT_EQ(all[0].at("items"), 3 * 600 / 2 + 5);  // edges of a closed mesh, and the floor's 5
  EXPECT_EQ(all[7].at("counters").at("wedge"), 500);
}

TEST_F(Bench, WholeFrames) {
  ASSERT_EQ(run_tiny({"--frame", "--light-samples", "100"}).code, 0);
  const std::vector<json> all = lines("lines");
  const std::string frame = "frame/scene/size=16/n=100/";
  EXPECT_THAT(names_of(all), ElementsAre(frame + "embree", frame + "edge-scatter", frame + "edge-scatter:rows=exact"));
  for (const json& line : all) {
    const json& seconds = line.at("seconds");
    double sum = 0;
    for (const char* phase : {"floats", "mesh", "view", "light", "evaluate"})
      sum += seconds.contains(phase) ? seconds.at(phase).at("median").get<double>() : 0;
    EXPECT_DOUBLE_EQ(line.at("frame").at("median"), sum) << line;  // all from one run
    double next_sum = 0;
    for (const char* phase : {"floats", "mesh", "view", "light", "evaluate"})
      next_sum +=
          line.at("nextSeconds").contains(phase) ? line.at("nextSeconds").at(phase).at("median").get<double>() : 0;
    EXPECT_DOUBLE_EQ(line.at("nextFrame").at("median"), next_sum) << line;
    EXPECT_EQ(seconds.contains("write"), line.at("method") != "embree") << line;
    EXPECT_EQ(line.at("nextSeconds").contains("mesh"), line.at("method") != "embree") << "its hierarchy stays";
    EXPECT_DOUBLE_EQ(line.at("timesFasterThanEmbree"),
                     all[0].at("frame").at("median").get<double>() / line.at("frame").at("median").get<double>());
  }
  ASSERT_EQ(run({"--frame", "--scene", "sphere:600", "--size", "16", "--light-samples", "65", "--runs", "1", "--json",
                 path("sphere")})
                .code,
            0);
  EXPECT_EQ(lines("sphere")[0].at("triangles"), 602);  // with the floor's 2
}

TEST_F(Bench, Sequences) {
  const Outcome outcome =
      run({"--sequence", "--scene", "knot:600", "--size", "18", "--frames", "3", "--json", path("lines")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json line = lines("lines").at(0);
  EXPECT_EQ(line.at("name"), "sequence/knot-600/size=18/frames=3");
  EXPECT_EQ(line.at("width"), 32);
  EXPECT_EQ(line.at("triangles"), 602);
  double work = 0;
  for (const char* phase : {"view", "light", "evaluate", "beauty", "write"})
    work += line.at("seconds").at(phase).get<double>();
  EXPECT_DOUBLE_EQ(line.at("work"), work);
  EXPECT_GT(line.at("elapsed"), work / 2) << "seconds of one machine";
  EXPECT_EQ(run({"--sequence", "--cpu"}).code, 2);
}

TEST_F(Bench, AMovingLight) {
  const Outcome outcome = run({"--wedges-per-frame", "--triangles", "600", "--runs", "1", "--json", path("lines")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::vector<json> all = lines("lines");
  EXPECT_THAT(names_of(all),
              ElementsAre("wedges-per-frame/host/triangles=600", "wedges-per-frame/device/triangles=600"));
  EXPECT_EQ(all[0].at("items"), all[1].at("items"));
  EXPECT_GT(all[1].at("items"), 10);
  EXPECT_FALSE(all[0].contains("hostRatio"));
  EXPECT_GT(all[1].at("hostRatio"), 0);
  EXPECT_EQ(all[0].at("counters").at("edgesOnHost"), all[0].at("items"));
  EXPECT_EQ(run({"--wedges-per-frame", "--cpu"}).code, 2);
}

TEST_F(Bench, WrongUseIsTold) {
  const std::string scene = tiny_scene();
  const std::vector<std::vector<std::string>> wrong = {
      {"--scene", scene, "--peer", "rays"},
      {"--scene", scene, "--reference", "photograph"},
      {"--scene", scene, "--light-samples", "5000"},
      {"--scene", scene, "--method", "view-sample", "--method", "view-sample"},
      {"--scene", scene, "--light-half", "1", "--light-half", "1"},
      {"--scene", "knot:7"},
      {"--scene", "sphere:7"},
      {"--scene", scene, "--frame", "--light-samples", "64"},  // too few: the Embree program begins with 64
      {"--scene", scene, "--frame", "--cpu"},
      {"--scene", scene, "--method", "nothing"},
      {"--runs"},
      {"--faster"}};
  for (const auto& arguments : wrong) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments.back() << ": " << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("penumbra-bench: error: ")) << arguments.back();
  }
}

}  // namespace
}  // namespace penumbra::tests
