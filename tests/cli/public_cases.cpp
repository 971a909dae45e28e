// SPDX-License-Identifier: Apache-2.0
// Tests files of kinds that people reported to other tools, with the expected result of each: every table in
// tests/public_cases/ (its README.md explains the tables' members).
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::filesystem::path kCases = PENUMBRA_PUBLIC_CASES;

/// Returns whether values agree; numbers may differ by 10⁻⁶ of themselves, for volumes of round shapes and bounds in
/// single precision.
bool agree(const json& wanted, const json& found) {
  if (wanted.is_number() && found.is_number()) {
    const double a = wanted.get<double>(), b = found.get<double>();
    return std::abs(a - b) <= 1e-6 * std::max(std::abs(a), 1e-3);
  }
  if (!wanted.is_array() || !found.is_array() || wanted.size() != found.size()) return wanted == found;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (!agree(wanted[i], found[i])) return false;
  }
  return true;
}

class PublicCases : public ProgramTest {
 protected:
  static json table(const std::string& name) {
    std::ifstream file(kCases / name);
    return json::parse(file)["cases"];
  }

  /// Compares the report of `inspect` on a file with the expected values.
  static void expect_inspected(const json& wanted, const json& report) {
    const std::string error = report.value("error", "");
    if (wanted.contains("refused")) {
      EXPECT_NE(error, "") << "it was read";
      for (const json& words : wanted["refused"]) EXPECT_THAT(error, HasSubstr(words.get<std::string>()));
      return;
    }
    ASSERT_EQ(error, "");
    for (const auto& [key, value] : wanted["expect"].items()) {
      EXPECT_TRUE(agree(value, report["total"][key])) << key << ": " << report["total"][key] << ", expected " << value;
    }
    const std::string notes = report["notes"].dump(-1, ' ', false, json::error_handler_t::replace);
    for (const json& words : wanted.value("notes", json::array()))
      EXPECT_THAT(notes, HasSubstr(words.get<std::string>()));
  }
};

TEST_F(PublicCases, MeshesAreReadAsTheyAreMeant) {
  const json cases = table("meshes.json");
  std::vector<std::string> arguments = {"inspect", "--quiet", "--list", "0", "--json", "-"};
  for (const json& wanted : cases) arguments.push_back((kCases / wanted["file"].get<std::string>()).string());
  const Outcome outcome = run(arguments);  // one process for all files: there are many
  ASSERT_EQ(outcome.code, 3) << "some are refused";
  const json reports = json::parse(outcome.out);
  ASSERT_EQ(reports.size(), cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    SCOPED_TRACE(cases[i]["file"].get<std::string>());
    expect_inspected(cases[i], reports[i]);
  }
}

TEST_F(PublicCases, EveryMeshIsInTheTableAndInTheReadme) {
  std::ifstream file(kCases / "README.md");
  const std::string readme{std::istreambuf_iterator<char>(file), {}};
  std::set<std::string> listed;
  for (const json& wanted : table("meshes.json")) {
    const std::filesystem::path mesh = wanted["file"].get<std::string>();
    EXPECT_TRUE(listed.insert(mesh.filename().string()).second) << mesh;
    EXPECT_THAT(readme, HasSubstr("`" + mesh.filename().string() + "`"));
    EXPECT_THAT(readme, HasSubstr(wanted.value("url", "")));
  }
  for (const auto& entry : std::filesystem::directory_iterator(kCases / "meshes")) {
    if (entry.path().extension() == ".json") continue;
    EXPECT_TRUE(listed.contains(entry.path().filename().string())) << entry.path();
  }
}

/// Also tests a method that adds up the shadows of wedges at each edge. The judge is the exact area, which does not use
/// edges in that way.
TEST_F(PublicCases, StraightCornersChangeNoShadow) {
  const std::string scene = (kCases / "meshes/ngon_straight_corners.json").string();
  const Outcome outcome = run({"compare", scene, "-o", path("out"), "--methods", "soft-volume", "--reference", "exact",
                               "--runs", "1", "--quiet"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json metrics = json::parse(read("out/metrics.json"));
  EXPECT_GT(metrics["methods"][0]["lights"][0]["judgedPixels"], 2000);
  EXPECT_LT(metrics["methods"][0]["error"]["max"], 1e-6);
}

}  // namespace
}  // namespace penumbra::tests
