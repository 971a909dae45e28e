// SPDX-License-Identifier: Apache-2.0
// Tests methods, devices, --help, --version and convert: people and programs can read what they print.
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <utility>

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
  for (const char* command : {"render", "compare", "inspect", "methods", "devices", "convert", "wedges", "submit"}) {
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

// An option may add something that a method can do, or take it away.
TEST_F(Tables, MethodsSayWhatAnOptionMakesOfThem) {
  const json methods = json::parse(run({"methods", "--json"}).out).at("methods");
  const auto variant = [&](const std::string& name, const json& options) {
    for (const json& method : methods) {
      if (method.at("name") != name) continue;
      for (const json& one : method.at("variants")) {
        if (one.at("options") == options) return one;
      }
    }
    return json();
  };
  const json spheres = variant("backproject", json::object({{"form", "sphere"}}));
  ASSERT_FALSE(spheres.is_null());
  EXPECT_THAT(spheres.at("lights").get<std::vector<std::string>>(), testing::Contains("sphere"));
  EXPECT_FALSE(spheres.at("textures").get<bool>());
  EXPECT_TRUE(variant("packet", json::object({{"sublights", "2"}})).is_null()) << "all of it takes textures";
  const json sparse = variant("bitmask", json::object({{"subsample", "2"}}));
  ASSERT_FALSE(sparse.is_null());
  EXPECT_EQ(sparse.at("output"), "scalar");
  EXPECT_TRUE(variant("contour", json::object({{"subsample", "2"}})).is_null()) << "it is scalar anyway";
  EXPECT_THAT(run({"methods"}).out,
              HasSubstr("with form=sphere: scalar; rectangle, disk, ellipse, polygon, sphere, sun, dome; no textures"));
}

TEST_F(Tables, DevicesSayWhatTheyCan) {
  EXPECT_EQ(run({"devices"}).code, 0);
  EXPECT_EQ(run({"devices", "--device", "cpu"}).code, 2) << "an option that would change nothing";
  const json devices = json::parse(run({"devices", "--json"}).out).at("devices");
  for (const json& device : devices) {
    EXPECT_FALSE(device.at("name").get<std::string>().empty());
    // Each device is usable, or the list says why not.
    EXPECT_EQ(device.at("usable").get<bool>(), device.at("refusals").empty()) << device;
  }
  const json contexts = json::parse(run({"devices", "--json"}).out).at("opengl");
  ASSERT_FALSE(contexts.empty()) << "where there is none, one says why";
  for (const json& context : contexts) {
    EXPECT_FALSE(context.at("name").get<std::string>().empty());
    EXPECT_EQ(context.at("usable").get<bool>(), context.at("refusals").empty()) << context;
    EXPECT_EQ(context.at("usable").get<bool>(), context.at("subpixelBits").get<int>() > 0) << context;
  }
}

TEST_F(Tables, TheSelfTestPassesHere) {
  const Outcome outcome = run({"devices", "--self-test", "--json"});
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  const json report = json::parse(outcome.out);
  EXPECT_TRUE(report.at("passed").get<bool>());
  EXPECT_GE(report.at("checks").size(), 15u);
  for (const json& check : report.at("checks")) {
    EXPECT_EQ(check.at("verdict"), "passed") << check;
    EXPECT_GT(check.at("compared").get<std::uint64_t>(), 0u) << check;
    EXPECT_EQ(check.at("wrong"), 0u) << check;
    EXPECT_LE(check.at("largest").get<double>(), check.at("allowed").get<double>()) << check;
    EXPECT_FALSE(check.at("rule").get<std::string>().empty()) << check;
  }
  const Outcome table = run({"devices", "--self-test"});
  EXPECT_EQ(table.code, 0);
  for (const char* word : {"compared", "differing", "largest", "allowed", "verdict", "OpenGL", "passed"}) {
    EXPECT_THAT(table.out, HasSubstr(word));
  }
}

TEST_F(Tables, WithoutAnEglDriverEverythingButOpenGlIsThere) {
  const std::map<std::string, std::string> nowhere{{"__EGL_VENDOR_LIBRARY_FILENAMES", path("no.json")}};
  const Outcome list = run({"devices", "--json"}, nowhere);
  EXPECT_EQ(list.code, 0);
  const json contexts = json::parse(list.out).at("opengl");
  ASSERT_EQ(contexts.size(), 1u);
  EXPECT_FALSE(contexts[0].at("usable").get<bool>());
  EXPECT_THAT(contexts[0].at("refusals")[0].get<std::string>(), HasSubstr("libegl-mesa0"));
  EXPECT_THAT(run({"devices"}, nowhere).out, HasSubstr("EGL finds no driver"));

  const std::string scene = tiny_scene();
  const auto draw = [&](const std::string& rasteriser) {
    return run({"render", scene, "-o", path(rasteriser + ".exr"), "--method", "shadow-map", "--method-option",
                "size=16", "--method-option", "rasteriser=" + rasteriser},
               nowhere);
  };
  EXPECT_EQ(draw("vulkan").code, 0);
  const Outcome refused = draw("opengl");
  EXPECT_EQ(refused.code, 4);
  EXPECT_THAT(refused.err, testing::AllOf(HasSubstr("no OpenGL"), HasSubstr("libgl1-mesa-dri")));
  EXPECT_THAT(files(), testing::Not(testing::Contains("opengl.exr")));

  const Outcome tested = run({"devices", "--self-test"}, nowhere);
  EXPECT_EQ(tested.code, 0) << tested.out;
  EXPECT_THAT(tested.out, testing::AllOf(HasSubstr("not run"), HasSubstr("OpenGL was left out"), HasSubstr("passed")));
}

TEST_F(Tables, ADriverWithAnOlderOpenGlIsRefusedWithItsReason) {
  const auto contexts = [&](std::map<std::string, std::string> environment) {
    return json::parse(run({"devices", "--json"}, std::move(environment)).out).at("opengl");
  };
  const json now = contexts({}), older = contexts({{"MESA_GL_VERSION_OVERRIDE", "3.3"}});
  ASSERT_EQ(now.size(), older.size());
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (now[i].at("driver").get<std::string>().find("Mesa") == std::string::npos) continue;  // the variable is Mesa's
    EXPECT_FALSE(older[i].at("usable").get<bool>());
    EXPECT_THAT(older[i].at("refusals")[0].get<std::string>(), HasSubstr("OpenGL 4.5"));
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
