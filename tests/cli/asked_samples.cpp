// SPDX-License-Identifier: Apache-2.0
// Tests which view samples methods do not evaluate because V there is known or is not written: no bit of a picture
// depends on this.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::tests {
namespace {

using nlohmann::json;

class AskedSamples : public ProgramTest {
 protected:
  [[nodiscard]] ExrFile picture(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), {"-o", path("out.exr"), "--stats", path("stats.json")});
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return read_exr(path("out.exr"));
  }
  [[nodiscard]] std::uint64_t counted(const std::string& name) const {
    const json stats = json::parse(read("stats.json"));
    return stats.at("counters").value(name, std::uint64_t{0});
  }
};

/// If a spot lamp's V is not written, methods evaluate only view samples in its cone.
TEST_F(AskedSamples, BesideConesNothingIsAsked) {
  const auto spot = [](double x, bool smooth) {
    return json{{"name", smooth ? "smooth" : "sharp"},
                {"sphere",
                 {{"center", {x, 3, 0.2}},
                  {"radius", 0.1},
                  {"cone", {{"direction", {-0.1 * x, -1, 0}}, {"inner", 12}, {"outer", 18}, {"smooth", smooth}}}}}};
  };
  json scene = {{"format", "penumbra-scene/1"},
                {"size", {48, 32}},
                {"camera", {{"eye", {0, 4, 5}}, {"target", {0, 0, 0}}}},
                {"meshes",
                 {{{"quad", {{"center", {0, 0, 0}}, {"halfU", {4, 0, 0}}, {"halfV", {0, 0, -4}}}}},
                  {{"quad", {{"center", {0.2, 1, 0}}, {"halfU", {0.5, 0.1, 0}}, {"halfV", {0, 0.1, -0.5}}}}}}},
                {"lights", {spot(-1, false), spot(1, true)}}};
  write("scene.json", scene.dump());
  const ExrFile all = picture({path("scene.json")});
  EXPECT_EQ(counted("viewSamplesBesideCones"), 0u);
  for (const char* method : {"", "raytrace", "view-sample"}) {
    std::vector<std::string> with = {path("scene.json")};
    if (*method != 0) with.insert(with.end(), {"--method", method});
    const ExrFile whole = picture(with);
    with.insert(with.end(), {"--layers", "beauty,sharp.V"});
    const ExrFile some = picture(with);
    const std::uint64_t beside = counted("viewSamplesBesideCones");
    EXPECT_GT(beside, 700u) << method << ": most of the floor, of one lamp";
    EXPECT_LT(beside, 48u * 32u) << method;
    for (const char* channel : {"R", "G", "B", "A", "sharp.V"})
      EXPECT_EQ(some.floats.at(channel), whole.floats.at(channel)) << method << " " << channel;
    (void)picture({path("scene.json"), "--layers", "sharp,smooth"});
    EXPECT_EQ(counted("viewSamplesBesideCones"), 0u);
  }
}

/// View samples are evaluated once for several moments where neither they nor casters between them and the light move.
/// The picture is the mean of its moments, each rendered alone.
TEST_F(AskedSamples, WhatIsStillIsAskedOnce) {
  (void)moving_scene();
  const std::vector<std::string> scene = {path("scene.glb"), "--camera", "B.2", "--size", "48x32", "--fps", "10"};
  const auto at = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = scene;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return picture(arguments);
  };
  const ExrFile mean = at({"--frame", "5", "--motion-samples", "3", "--shutter", "3"});
  const std::uint64_t still = counted("viewSamplesStill");
  EXPECT_GT(still, 300u);
  EXPECT_EQ(mean.attributes.at("penumbra.motionSamples"), "3");
  std::vector<ExrFile> moments;
  for (const char* frame : {"4", "5", "6"}) moments.push_back(at({"--frame", frame}));
  std::size_t moving = 0;
  for (const char* channel : {"R", "G", "B", "A", "V"}) {
    for (std::size_t i = 0; i < mean.floats.at(channel).size(); ++i) {
      double sum = 0;
      for (const ExrFile& moment : moments) sum += double{moment.floats.at(channel)[i]};
      // Times are computed in different orders and may differ by one rounding of a double; radiance goes up to 20.
      ASSERT_NEAR(mean.floats.at(channel)[i], sum / 3, 2e-5) << channel << " " << i;
      moving += moments[0].floats.at(channel)[i] != moments[2].floats.at(channel)[i] ? 1 : 0;
    }
  }
  EXPECT_GT(moving, 50u);
}

}  // namespace
}  // namespace penumbra::tests
