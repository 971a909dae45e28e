// SPDX-License-Identifier: Apache-2.0
// Tests scene files as other programs write them, from public reports (tests/public_cases/README.md): what the program
// reads from each must agree with values computed without it.
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

const std::filesystem::path kSceneCases = PENUMBRA_PUBLIC_CASES;

class PublicScenes : public ProgramTest {
 protected:
  /// Expects these values in the scene that `convert` wrote.
  void expect_scene(const json& expected) const {
    const json scene = json::parse(read("out.json"));
    for (const auto& [key, value] : expected.items()) {
      if (key == "triangles") {
        std::size_t triangles = 0;
        for (const json& mesh : scene.at("meshes")) triangles += mesh.at("triangles").size();
        EXPECT_EQ(triangles, value.get<std::size_t>());
      } else if (key == "lights") {
        EXPECT_EQ(scene.at("lights").size(), value.get<std::size_t>());
      } else if (key == "bounds") {
        for (const auto& [name, bounds] : value.items()) expect_bounds(scene, name, bounds);
      } else {
        const double found = scene.at(json::json_pointer(key)).get<double>(), wanted = value.get<double>();
        // Files hold single precision, and angles go through a cosine.
        EXPECT_NEAR(found, wanted, 1e-5 * std::max(std::abs(wanted), 1e-3)) << key;
      }
    }
  }

 private:
  static void expect_bounds(const json& scene, const std::string& name, const json& bounds) {
    const auto mesh = std::ranges::find_if(scene.at("meshes"), [&](const json& one) { return one.at("name") == name; });
    ASSERT_NE(mesh, scene.at("meshes").end()) << name;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const json& triangle : mesh->at("triangles")) {
        for (std::size_t i = axis; i < 9; i += 3) {
          low = std::min(low, triangle.at(i).get<double>());
          high = std::max(high, triangle.at(i).get<double>());
        }
      }
      EXPECT_NEAR(low, bounds.at(0).at(axis).get<double>(), 1e-6) << name << " " << axis;
      EXPECT_NEAR(high, bounds.at(1).at(axis).get<double>(), 1e-6) << name << " " << axis;
    }
  }
};

TEST_F(PublicScenes, AreReadAsTheyWereMeant) {
  std::ifstream table(kSceneCases / "scenes.json");
  const json cases = json::parse(table).at("cases");
  ASSERT_GT(cases.size(), 30u);
  for (const json& one : cases) {
    const std::string file = (kSceneCases / "scenes" / one.at("file").get<std::string>()).string();
    SCOPED_TRACE(file + ": " + one.at("what").get<std::string>());
    std::vector<std::string> arguments =
        one.value("arguments", std::vector<std::string>{"convert", "FILE", "-o", "OUT.json"});
    for (std::string& argument : arguments) {
      if (argument == "FILE") argument = file;
      if (argument.starts_with("OUT")) argument = path("out" + argument.substr(3));
    }
    std::filesystem::remove(path("out.json"));
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, one.value("exit", 0)) << outcome.err;
    const auto warnings = one.value("warnings", std::vector<std::string>{});
    for (const std::string& text : warnings) EXPECT_THAT(outcome.err, HasSubstr(text));
    if (warnings.empty() && one.contains("warnings")) {
      EXPECT_THAT(outcome.err, Not(HasSubstr("warning"))) << "nothing to say";
    }
    for (const std::string& text : one.value("output", std::vector<std::string>{}))
      EXPECT_THAT(outcome.out, HasSubstr(text));
    for (const std::string& text : one.value("absent", std::vector<std::string>{}))
      EXPECT_THAT(outcome.out + outcome.err, Not(HasSubstr(text)));
    if (!one.contains("expect")) continue;
    ASSERT_TRUE(std::filesystem::exists(path("out.json")));
    expect_scene(one.at("expect"));
  }
}

}  // namespace
}  // namespace penumbra::tests
