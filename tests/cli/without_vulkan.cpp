// SPDX-License-Identifier: Apache-2.0
// Tests the program on a machine without a Vulkan driver: methods that run on the processor give the same bytes as with
// a driver, and the others are refused by name.

#include "session/methods.hpp"
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace penumbra::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::map<std::string, std::string> kNowhere = {{"VK_DRIVER_FILES", "/nowhere.json"},
                                                     {"VK_ICD_FILENAMES", "/nowhere.json"}};

/// Returns whether the method can handle the lamp of tiny_scene().
bool does_lamps(const visibility::MethodDescription& method) {
  return method.lights.contains(visibility::LightKind::rectangle);
}

class WithoutVulkan : public ProgramTest {
 protected:
  [[nodiscard]] Outcome render(const std::vector<std::string>& more, const std::string& out,
                               const std::map<std::string, std::string>& environment) const {
    std::vector<std::string> arguments = {"--quiet", "render", scene_, "-o", path(out), "--size", "24x16"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments, environment);
  }

  const std::string scene_ = tiny_scene();
};

TEST_F(WithoutVulkan, ProcessorMethodsGiveTheSameBytes) {
  std::vector<std::vector<std::string>> runs = {{}, {"--pixel-samples", "4"}};
  for (const visibility::MethodDescription* method : session::all_methods()) {
    if (!session::needs_device(method->name, {}) && does_lamps(*method)) runs.push_back({"--method", method->name});
  }
  ASSERT_GE(runs.size(), 9U);  // the default twice, and at least seven methods
  for (const std::vector<std::string>& more : runs) {
    const std::string what = more.empty() ? "default" : more.back();
    ASSERT_EQ(render(more, "with.exr", {}).code, 0) << what;
    const Outcome without = render(more, "without.exr", kNowhere);
    ASSERT_EQ(without.code, 0) << what << ": " << without.err;
    EXPECT_EQ(read("with.exr"), read("without.exr")) << what;
  }
}

TEST_F(WithoutVulkan, DeviceMethodsAreRefusedByName) {
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{"--method", "pcss"},
                                             {"--method", "edge-scatter", "--method-option", "engine=vulkan"},
                                             {"--method", "raytrace", "--device", "1"}}) {
    const Outcome outcome = render(more, "out.exr", kNowhere);
    EXPECT_EQ(outcome.code, 4) << more[1];
    EXPECT_THAT(outcome.err, HasSubstr("no Vulkan device")) << more[1];
    if (more[1] != "raytrace") {  // raytrace needs no device, but one was named
      EXPECT_THAT(outcome.err, HasSubstr(more[1] + ": "));
    }
    EXPECT_THAT(files(), ElementsAre("scene.json"));
  }
}

TEST_F(WithoutVulkan, CompareLeavesOutOfAGroupWhatNeedsADevice) {
  const std::vector<std::string> base = {
      "compare", scene_,   "-o", path("out"), "--size", "16x12", "--light-samples", "4", "--reference-samples",
      "4",       "--runs", "1",  "--methods"};
  const auto compare = [&](const char* methods) {
    auto arguments = base;
    arguments.emplace_back(methods);
    return run(arguments, kNowhere);
  };
  const Outcome all = compare("all");
  ASSERT_EQ(all.code, 0) << all.err;
  const auto metrics = nlohmann::json::parse(read("out/metrics.json"));
  std::vector<std::string> ran;
  for (const auto& entry : metrics.at("methods")) ran.push_back(entry.at("method"));
  for (const visibility::MethodDescription* method : session::all_methods()) {
    const bool needs = session::needs_device(method->name, {});
    if (!does_lamps(*method)) continue;
    EXPECT_EQ(std::ranges::count(ran, method->name) == 0, needs) << method->name;
    if (!needs) continue;
    EXPECT_THAT(all.err, HasSubstr(method->name));
  }
  // A named method fails alone; the others are compared all the same.
  const Outcome named = compare("pcf,edge-scatter");
  EXPECT_EQ(named.code, 4);
  EXPECT_THAT(named.err, AllOf(HasSubstr("pcf: "), HasSubstr("no Vulkan device")));
  EXPECT_EQ(nlohmann::json::parse(read("out/metrics.json")).at("methods").at(1).at("method"), "edge-scatter");
  const Outcome image = compare("image");
  EXPECT_EQ(image.code, 4);
  EXPECT_THAT(image.err, HasSubstr("no Vulkan device"));
}

TEST_F(WithoutVulkan, OtherCommandsWork) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"methods"},
                                             {"convert", scene_, "-o", path("copy.json")},
                                             {"inspect", scene_},
                                             {"wedges", scene_, "--validate", "--light", "key"}}) {
    const Outcome outcome = run(arguments, kNowhere);
    EXPECT_EQ(outcome.code, 0) << arguments.front() << ": " << outcome.err;
    EXPECT_THAT(outcome.err, Not(HasSubstr("Vulkan")));
  }
  const Outcome devices = run({"devices", "--json"}, kNowhere);
  EXPECT_EQ(devices.code, 0);
  EXPECT_THAT(devices.err, HasSubstr("Vulkan"));
  EXPECT_THAT(nlohmann::json::parse(devices.out).at("devices"), IsEmpty());
}

}  // namespace
}  // namespace penumbra::tests
