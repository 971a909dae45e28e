// SPDX-License-Identifier: Apache-2.0
// Tests `sweep`: its three files agree, and its conclusions follow from its rows.
#include "app/sweep/ranges.hpp"
#include "base/error.hpp"
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <map>
#include <sstream>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> values_of(const std::string& text) {
  const std::vector<std::string> texts = {text};
  const auto keys = app::parse_over(texts);
  return keys.size() == 1 ? keys.front().values : std::vector<std::string>{"several keys"};
}

TEST(SweepRanges, AreDoubledSteppedOrListed) {
  EXPECT_THAT(values_of("size=256..2048"), ElementsAre("256", "512", "1024", "2048"));
  EXPECT_THAT(values_of("size=3..20"), ElementsAre("3", "6", "12"));
  EXPECT_THAT(values_of("half=0.1..0.4+0.1"), ElementsAre("0.1", "0.2", "0.3", "0.4"));
  EXPECT_THAT(values_of("layers=1,2,4"), ElementsAre("1", "2", "4"));
  EXPECT_THAT(values_of("x=-3..-1+1"), ElementsAre("-3", "-2", "-1"));
  EXPECT_THAT(values_of("fill=none,edges"), ElementsAre("none", "edges"));
  EXPECT_THAT(values_of("size=64,256..512"), ElementsAre("64", "256", "512"));
  const std::vector<std::string> texts = {"size=1..2,layers=1,2", "light.half=0.5"};
  const auto keys = app::parse_over(texts);
  ASSERT_EQ(keys.size(), 3U);
  EXPECT_EQ(keys[1].name, "layers");
  EXPECT_THAT(keys[1].values, ElementsAre("1", "2"));
  EXPECT_EQ(keys[2].name, "light.half");
  for (const char* wrong : {"", "size", "=3", "size=", "size=5..2", "size=0..4", "size=a..b", "size=1..2+0",
                            "size=1..1e9+0.5", "size=1,,2", "size=1,size=2"}) {
    EXPECT_THROW(values_of(wrong), UsageError) << wrong;
  }
}

class SweepTest : public ProgramTest {
 protected:
  Outcome sweep(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"sweep", tiny_scene(), "-o", path("dir"), "--runs", "1", "--size", "32x32"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  /// Returns the rows, each a map from column names to values.
  [[nodiscard]] std::vector<std::map<std::string, std::string>> csv() const {
    std::istringstream text(read("dir/sweep.csv"));
    std::vector<std::vector<std::string>> lines;
    for (std::string line; std::getline(text, line);) {
      EXPECT_EQ(line.back(), '\r');
      line.pop_back();
      std::istringstream cells(line + ",");
      lines.emplace_back();
      for (std::string cell; std::getline(cells, cell, ',');) lines.back().push_back(cell);
    }
    std::vector<std::map<std::string, std::string>> rows;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      EXPECT_EQ(lines[i].size(), lines[0].size());
      std::map<std::string, std::string>& row = rows.emplace_back();
      for (std::size_t column = 0; column < lines[0].size(); ++column) row[lines[0][column]] = lines[i][column];
    }
    return rows;
  }
};

TEST_F(SweepTest, RowsAreWhatCompareSays) {
  const Outcome outcome = sweep({"--methods", "edge-scatter,pcf:window=3,pcss", "--over",
                                 "size=32..64,light-samples=4,64", "--over", "light.half=0.2,0.6"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json all = json::parse(read("dir/sweep.json"));
  EXPECT_EQ(all.at("reference").at("options").at("rows"), "exact");
  const json& rows = all.at("rows");
  ASSERT_EQ(rows.size(), 2U * (2 + 2 + 2));
  const auto table = csv();
  ASSERT_EQ(table.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(table[i].at("entry"), rows[i].at("entry"));
    EXPECT_EQ(table[i].at("light.half"), rows[i].at("light").at("light.half"));
    EXPECT_NEAR(std::stod(table[i].at("rmse")), rows[i].at("error").at("rmse").get<double>(), 1e-8);
    EXPECT_EQ(table[i].at("size"), rows[i].at("options").value("size", ""));
    EXPECT_EQ(table[i].at("pareto") == "1", rows[i].at("pareto").get<bool>());
  }
  // Runs `compare` for the same, with the light at that size in the file.
  std::string scene = read("scene.json");
  EXPECT_THAT(read("dir/sweep.svg"), HasSubstr("light.half=0.6"));
  json at_size = json::parse(scene);
  json& light = at_size.at("lights").at(0).at("rectangle");
  const double half =
      std::max(std::abs(light.at("halfU").at(0).get<double>()), std::abs(light.at("halfV").at(2).get<double>()));
  for (const char* axis : {"halfU", "halfV"}) {
    for (auto& number : light.at(axis)) number = number.get<double>() * 0.6 / half;
  }
  write("sized.json", at_size.dump());
  ASSERT_EQ(run({"compare", path("sized.json"), "-o", path("compared"), "--runs", "1", "--size", "32x32", "--methods",
                 "pcf:window=3:size=64", "--reference", "edge-scatter:rows=exact"})
                .code,
            0);
  const json compared = json::parse(read("compared/metrics.json")).at("methods").at(0);
  const auto row = std::ranges::find_if(rows, [](const json& one) {
    return one.at("entry") == "pcf:window=3:size=64" && one.at("light").at("light.half") == "0.6";
  });
  ASSERT_NE(row, rows.end());
  EXPECT_DOUBLE_EQ(row->at("error").at("rmse").get<double>(), compared.at("error").at("rmse").get<double>());
}

TEST_F(SweepTest, ConclusionsFollowFromTheRows) {
  ASSERT_EQ(
      sweep({"--methods", "edge-scatter,shadow-map", "--over", "size=16..64", "--over", "light-samples=4..256"}).code,
      0);
  const json all = json::parse(read("dir/sweep.json"));
  const json& rows = all.at("rows");
  const auto error_of = [](const json& row) { return row.at("error").at("rmse").get<double>(); };
  const auto seconds_of = [](const json& row) { return row.at("seconds").at("shadow").get<double>(); };
  for (const json& row : rows) {
    const bool beaten = std::ranges::any_of(rows, [&](const json& other) {
      return error_of(other) <= error_of(row) && seconds_of(other) <= seconds_of(row) &&
             (error_of(other) < error_of(row) || seconds_of(other) < seconds_of(row));
    });
    EXPECT_EQ(row.at("pareto").get<bool>(), !beaten) << row.at("entry");
  }
  const std::map<std::string, double> limits = {{"1/64", 1.0 / 64}, {"1/128", 1.0 / 128}, {"1/256", 1.0 / 256}};
  ASSERT_EQ(all.at("methods").size(), 2U);
  for (const json& method : all.at("methods")) {
    for (const auto& [name, limit] : limits) {
      std::optional<double> least;
      for (const json& row : rows) {
        if (row.at("method") == method.at("method") && error_of(row) <= limit)
          least = std::min(least.value_or(1e9), seconds_of(row));
      }
      const json& to = method.at("secondsTo").at(name);
      ASSERT_EQ(to.is_null(), !least.has_value()) << method.at("method") << name;
      if (least) {
        EXPECT_EQ(to.at("seconds").get<double>(), *least);
      }
    }
  }
}

/// The scene may come last, and options for all methods apply with every number of light samples.
TEST_F(SweepTest, TakesOptionsOfAllMethodsAndTheSceneLast) {
  const Outcome outcome =
      run({"sweep", "-o", path("dir"), "--runs", "1", "--size", "16x16", "--methods", "edge-scatter,pcf",
           "--method-option", "size=32", "--over", "light-samples=4,16", tiny_scene()});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json rows = json::parse(read("dir/sweep.json")).at("rows");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(std::ranges::count_if(rows, [](const json& row) { return row.at("options").value("size", "") == "32"; }),
            1);
}

TEST_F(SweepTest, LightsWithoutTheSizeStayAsTheyAreAndAreNamed) {
  std::ofstream(path("sky.json")) << R"({"format": "penumbra-scene/1", "size": [24, 24],
    "camera": {"eye": [0, 3, 4], "target": [0, 0.5, 0], "verticalFov": 45},
    "meshes": [{"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [3, 0, 0], "halfV": [0, 0, -3]}},
               {"name": "card", "quad": {"center": [0, 1, 0], "halfU": [0.5, 0, 0], "halfV": [0, 0, -0.5]}}],
    "lights": [{"name": "key", "rectangle": {"center": [0, 3, 0], "halfU": [0.3, 0, 0], "halfV": [0, 0, 0.3]}},
               {"name": "sun", "sun": {"direction": [0.2, -1, 0], "angle": 2}},
               {"name": "sky", "dome": {}}]})";
  const auto sweep_sky = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {
        "sweep",       path("sky.json"), "-o",       path("dir"),           "--runs", "1", "--methods",
        "pcf:size=64", "--reference",    "raytrace", "--reference-samples", "64"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  const Outcome outcome = sweep_sky({"--over", "light.half=0.1,0.6"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("light \"sky\" is a dome, which has no size, and stays as it is"));
  EXPECT_THAT(outcome.err, HasSubstr("light \"sun\" has another size, light.angle, and stays as it is"));
  const json rows = json::parse(read("dir/sweep.json")).at("rows");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_NE(rows[0].at("error").at("rmse"), rows[1].at("error").at("rmse"));  // the key's size varies
  const Outcome named = sweep_sky({"--over", "light.half=0.1,0.6", "--light", "key", "--light", "sky"});
  EXPECT_EQ(named.code, 2);
  EXPECT_THAT(named.err, HasSubstr("light \"sky\" is a dome, which has no size; choose others with --light"));
}

TEST_F(SweepTest, RefusesWhatCannotVary) {
  const auto refused = [&](std::vector<std::string> arguments, const char* word, int code = 2) {
    const Outcome outcome = sweep(std::move(arguments));
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(word));
    EXPECT_FALSE(std::filesystem::exists(path("dir")));
  };
  refused({"--methods", "pcf", "--over", "windw=3,5"}, "did you mean window");
  refused({"--methods", "pcf", "--over", "light.angle=3"}, "is a sun");
  refused({"--methods", "pcf", "--over", "light-samples=4"}, "counts light samples");
  refused({"--methods", "pcf:size=64", "--over", "size=64,128"}, "to vary");
  refused({"--methods", "edge-scatter", "--over", "light-samples=4,x"}, "light-samples x");
  refused({"--methods", "pcf", "--over", "light.half=0"}, "above 0");
  refused({"--methods", "pcf", "--over", "size=3..4"}, "size");
  refused({"--methods", "pcf", "--over", "size"}, "KEY=VALUE");
  refused({"--methods", "pcf", "--over", "size=64", "--reference", "pcss"}, "exact areas");
}

}  // namespace
}  // namespace penumbra::tests
