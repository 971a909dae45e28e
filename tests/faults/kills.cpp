// SPDX-License-Identifier: Apache-2.0
// Tests the program killed at random moments while it renders and compares: no file is torn, and the next run leaves
// only its own files.
#include "base/exr.hpp"
#include "tests/faults/child.hpp"

#include <gmock/gmock.h>

#include <array>
#include <chrono>
#include <random>
#include <thread>

namespace penumbra::tests {
namespace {

using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

class KillFaults : public FaultTest {
 protected:
  void kill_at_random(const Conditions& conditions, int runs) const {
    std::filesystem::create_directories(folder_ / "dir");
    std::mt19937 random(13);
    for (int run = 0; run < runs; ++run) {
      const int signal = std::array{SIGKILL, SIGINT, SIGTERM, SIGHUP}[static_cast<std::size_t>(run % 4)];
      const auto moment = std::chrono::microseconds(random() % 600'000);
      SCOPED_TRACE("signal " + std::to_string(signal) + " after " + std::to_string(moment.count()) + " us");
      Running program(conditions);
      std::this_thread::sleep_for(moment);
      program.send(signal);
      const Ending ending = program.wait();
      // Before the program's main begins, signals have the system's default action.
      EXPECT_THAT(ending.code, AnyOf(0, 130, 128 + signal)) << ending.err;
      if (ending.code == 130) {
        expect_no_parts();
      }
      expect_whole();
      ASSERT_EQ(run_under({.arguments = {"convert", path("scene.json"), "-o", path("dir/copy.obj")}}).code, 0);
      ASSERT_EQ(run_under({.arguments = {"convert", path("scene.json"), "-o", path("copy.obj")}}).code, 0);
      expect_no_parts();
    }
  }
  void expect_no_parts() const {
    for (const std::string& file : files()) EXPECT_THAT(file, Not(HasSubstr(".part")));
  }
  void expect_whole() const {
    for (const std::string& file : files()) {
      if (file.find(".part") != std::string::npos) continue;
      if (file.ends_with(".exr")) {
        EXPECT_NO_THROW((void)read_exr(folder_ / file)) << file;
      }
      if (file.ends_with(".json") && file != "scene.json") {
        EXPECT_EQ(read(file).back(), '\n') << file;
      }
      if (file.ends_with("report.html")) {
        EXPECT_THAT(read(file), HasSubstr("</html>"));
      }
    }
  }
};

TEST_F(KillFaults, LongKilledWhileItRenders) {
  (void)small_scene();
  for (const bool named : {false, true}) {
    Conditions conditions = {.arguments = {"render", path("scene.json"), "-o", path("out.exr"), "--bits",
                                           path("out.bits"), "--stats", path("stats.json"), "--method", "raytrace",
                                           "--size", "320x240"}};
    if (named) conditions.environment["PENUMBRA_TEST_NAMED_PARTS"] = "1";
    kill_at_random(conditions, 60);
  }
}

TEST_F(KillFaults, LongKilledWhileItCompares) {
  (void)small_scene();
  kill_at_random({.arguments = {"compare", path("scene.json"), "-o", path("dir"), "--methods",
                                "edge-scatter,view-sample", "--runs", "1", "--bits", "--png"},
                  .environment = {{"PENUMBRA_TEST_NAMED_PARTS", "1"}}},
                 60);
}

}  // namespace
}  // namespace penumbra::tests
