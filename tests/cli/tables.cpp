// methods, devices, --help, --version, convert: what they print can be read by people and by programs.
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

using Tables = ProgramTest;

TEST_F(Tables, VersionAndHelpGoToStdout) {
  const Outcome version = run({"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_THAT(version.out, HasSubstr("penumbra "));
  EXPECT_THAT(run({"--help"}).out, testing::AllOf(HasSubstr("render"), HasSubstr("Exit codes")));
  for (const char* command : {"render", "compare", "inspect", "methods", "devices", "convert", "wedges"}) {
    const Outcome help = run({command, "--help"});
    EXPECT_EQ(help.code, 0) << command;
    EXPECT_THAT(help.out, HasSubstr("--")) << command;
    EXPECT_TRUE(help.err.empty()) << command << ": " << help.err;
  }
}

TEST_F(Tables, MethodsSayWhatTheyAre) {
  const Outcome table = run({"methods"});
  EXPECT_EQ(table.code, 0);
  EXPECT_THAT(table.out, testing::AllOf(HasSubstr("raytrace"), HasSubstr("view-sample")));
  const json methods = json::parse(run({"methods", "--json"}).out).at("methods");
  ASSERT_FALSE(methods.empty());
  for (const json& method : methods) {
    for (const char* key : {"name", "family", "paper", "output", "exactFor"}) {
      EXPECT_FALSE(method.at(key).get<std::string>().empty()) << method << " " << key;
    }
    EXPECT_FALSE(method.at("lights").empty()) << method;
    EXPECT_TRUE(method.at("options").is_array()) << method;
    for (const json& option : method.at("options")) {
      const std::string otherwise = option.at("default");
      ASSERT_NE(option.contains("choices"), option.contains("range")) << option;
      if (option.contains("choices")) {
        EXPECT_THAT(option.at("choices").get<std::vector<std::string>>(), testing::Contains(otherwise));
      } else {
        EXPECT_GE(std::stod(otherwise), option.at("range").at("least").get<double>()) << option;
        EXPECT_LE(std::stod(otherwise), option.at("range").at("most").get<double>()) << option;
      }
    }
  }
}

TEST_F(Tables, DevicesSayWhatTheyCan) {
  EXPECT_EQ(run({"devices"}).code, 0);
  const json devices = json::parse(run({"devices", "--json"}).out).at("devices");
  for (const json& device : devices) {
    EXPECT_FALSE(device.at("name").get<std::string>().empty());
    // Either it can be used, or it is said why not.
    EXPECT_EQ(device.at("usable").get<bool>(), device.at("refusals").empty()) << device;
  }
}

TEST_F(Tables, ConvertWritesWhatItRead) {
  const std::string scene = tiny_scene();
  ASSERT_EQ(run({"convert", scene, "-o", path("a.json")}).code, 0);
  ASSERT_EQ(run({"convert", path("a.json"), "-o", path("b.json")}).code, 0);
  EXPECT_EQ(read("a.json"), read("b.json"));
  for (const char* name : {"scene.glb", "scene.obj"}) {
    const Outcome outcome = run({"convert", scene, "-o", path(name)});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_GT(read(name).size(), 50u);
  }
}

}  // namespace
}  // namespace penumbra::tests
