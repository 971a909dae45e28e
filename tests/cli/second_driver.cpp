// SPDX-License-Identifier: Apache-2.0
// Tests on a second software driver, SwiftShader, from Debian's package chromium: it has subgroups of four lanes, and
// neither double precision nor 64-bit integers. Methods that run on it must be right there, too; others are refused by
// name.

#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

constexpr const char* kDriver = "/usr/lib/chromium/vk_swiftshader_icd.json";
const std::map<std::string, std::string> kThere = {{"VK_DRIVER_FILES", kDriver}, {"VK_ICD_FILENAMES", kDriver}};

constexpr double kPatience = 1800;  // seconds: compiling some passes takes long

class SecondDriver : public ProgramTest {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kDriver)) GTEST_SKIP() << "no " << kDriver << ": Debian's package chromium has it";
  }

  [[nodiscard]] Outcome render(const std::string& scene, const std::vector<std::string>& more, const std::string& out,
                               const std::map<std::string, std::string>& environment) const {
    std::vector<std::string> arguments = {"--quiet", "render", scene, "-o", path(out + ".exr")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(
        {.arguments = arguments, .environment = environment, .interrupt_after = {}, .timeout = kPatience});
  }
  /// Masks are exact, so every driver gives the same bits.
  void expect_the_same(const std::string& scene, const std::string& method, std::vector<std::string> options) const {
    options.insert(options.end(), {"--method", method, "--method-option", "engine=vulkan"});
    const auto bits_of = [&](const std::string& out, const std::map<std::string, std::string>& environment) {
      std::vector<std::string> more = options;
      more.insert(more.end(), {"--bits", path(out + ".bits")});
      const Outcome outcome = render(scene, more, out, environment);
      EXPECT_EQ(outcome.code, 0) << method << ", " << scene << ": " << outcome.err;
      return read(out + ".bits");
    };
    const std::string here = bits_of("here", {});
    EXPECT_GT(here.size(), 4096U);
    EXPECT_EQ(here, bits_of("there", kThere)) << method << ", " << scene;
  }
};

TEST_F(SecondDriver, WhatItCannotRunIsSaid) {
  const json device = json::parse(run({"devices", "--json"}, kThere).out).at("devices").at(0);
  EXPECT_THAT(device.at("name").get<std::string>(), HasSubstr("SwiftShader"));
  EXPECT_TRUE(device.at("usable").get<bool>()) << device;
  EXPECT_EQ(device.at("lacks"), json::array({"shaderFloat64", "shaderInt64", "shaderBufferInt64Atomics"}));
  std::vector<std::string> refused;
  for (const json& one : device.at("refusedMethods")) {
    refused.push_back(one.at("method").get<std::string>());
    EXPECT_THAT(one.at("reason").get<std::string>(), HasSubstr("needs shaderFloat64"));
  }
  EXPECT_THAT(refused, UnorderedElementsAre("hard-volume", "soft-volume", "soft-volume-blend", "wedge-ramp", "plateaus",
                                            "hybrid-volume", "depth-complexity:variant=forest"));
  EXPECT_THAT(run({"devices"}, kThere).out,
              AllOf(HasSubstr("yes, with exceptions"), HasSubstr("view samples"), HasSubstr("hard-volume")));
}

TEST_F(SecondDriver, ARefusedMethodNamesWhatIsMissing) {
  const Outcome outcome = render(tiny_scene(), {"--method", "hard-volume"}, "out", kThere);
  EXPECT_EQ(outcome.code, 4);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("hard-volume: "), HasSubstr("shaderFloat64"), HasSubstr("SwiftShader")));
  EXPECT_THAT(files(), ElementsAre("scene.json"));
}

/// The list leaves out edge-scatter, whose second pass takes this driver a quarter of a minute to compile.
TEST_F(SecondDriver, ExactMethodsGiveTheSameBits) {
  const std::string scene = tiny_scene();
  for (const char* method : {"view-sample", "depth-complexity"}) expect_the_same(scene, method, {"--size", "24x16"});
}

TEST_F(SecondDriver, ExactMethodsGiveTheSameBitsOnScenesFull) {
  for (const char* scene : {"contact.json", "large-penumbra.json"}) {
    for (const char* pattern : {"rows", "sobol"}) {
      for (const std::string method : {"edge-scatter", "view-sample", "depth-complexity"}) {
        // This takes many minutes to compile; the self-test below does it once.
        if (method == "edge-scatter" && std::string(pattern) == "sobol") continue;
        expect_the_same(std::string(PENUMBRA_SCENES) + "/" + scene, method,
                        {"--size", "64x48", "--light-samples", "64", "--sample-pattern", pattern});
      }
    }
  }
}

/// Each pass that has a twin in C++, including passes of maps, agrees with it. Tables of sines and cosines
/// (convolution) store half of each sine, and so may be off by half of 2^-11, the error that Vulkan permits for a sine.
TEST_F(SecondDriver, PassesAreTheirTwinsFull) {
  const Outcome outcome = run_program({.arguments = {"devices", "--self-test", "--json"},
                                       .environment = kThere,
                                       .interrupt_after = {},
                                       .timeout = kPatience});
  EXPECT_EQ(outcome.code, 1) << outcome.out << outcome.err;
  const json report = json::parse(outcome.out);
  std::vector<std::string> not_run;
  for (const json& check : report.at("checks")) {
    if (check.at("verdict") == "not run") {
      not_run.push_back(check.at("pass").get<std::string>());
    } else if (check.at("pass").get<std::string>().starts_with("prefiltered")) {
      EXPECT_LE(check.at("largest").get<double>(), 0x1p-12) << check;
    } else {
      EXPECT_EQ(check.at("verdict"), "passed") << check;
    }
  }
  EXPECT_THAT(not_run, ElementsAre("view samples (Vulkan)", "penumbra wedges"));
}

/// Methods whose passes all run there give a picture, with the validation layer silent.
TEST_F(SecondDriver, EveryOtherMethodRunsFull) {
  const std::string scene = tiny_scene();
  int ran = 0, refused = 0;
  const json methods = json::parse(run({"methods", "--json"}).out);
  for (const json& method : methods.at("methods")) {
    const std::string name = method.at("name").get<std::string>();
    const Outcome outcome = render(scene, {"--method", name, "--size", "24x16"}, "out", kThere);
    if (outcome.code == 4 && outcome.err.find("needs shaderFloat64") != std::string::npos) {
      ++refused;
      continue;
    }
    EXPECT_EQ(outcome.code, 0) << name << ": " << outcome.err;
    ++ran;
  }
  EXPECT_EQ(refused, 4);
  EXPECT_GE(ran, 24);
}

}  // namespace
}  // namespace penumbra::tests
