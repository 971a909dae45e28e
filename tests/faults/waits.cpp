// SPDX-License-Identifier: Apache-2.0
// Tests a device that takes work and does not finish it: the program still ends, in an orderly way.
#include "tests/faults/child.hpp"

#include <gmock/gmock.h>

namespace penumbra::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class WaitFaults : public FaultTest {
 protected:
  /// Work of minutes in few submissions for Mesa's software driver with one thread.
  [[nodiscard]] Conditions long_work() const {
    return {.arguments = {"render", small_scene(), "-o", path("out.exr"), "--bits", path("out.bits"), "--method",
                          "depth-complexity", "--method-option", "engine=vulkan", "--size", "2048x2048",
                          "--light-samples", "4096", "--device", "cpu"},
            .environment = {{"LP_NUM_THREADS", "1"}}};
  }
};

TEST_F(WaitFaults, AWaitBeyondItsLimitIs4) {
  Conditions conditions = long_work();
  conditions.environment["PENUMBRA_DEVICE_TIMEOUT"] = "1";
  const Ending ending = run_under(conditions);
  EXPECT_EQ(ending.code, 4) << ending.err;
  EXPECT_THAT(ending.err, HasSubstr("PENUMBRA_DEVICE_TIMEOUT"));
  EXPECT_THAT(files(), ElementsAre("scene.json"));
}

TEST_F(WaitFaults, ALimitThatIsNoneIs2) {
  for (const char* value : {"", "0", "-1", "soon", "1.5", "99999999999999999999"}) {
    const Ending ending = run_under({.arguments = {"render", small_scene(), "-o", path("out.exr"), "--method", "pcf"},
                                     .environment = {{"PENUMBRA_DEVICE_TIMEOUT", value}}});
    EXPECT_EQ(ending.code, 2) << value << ": " << ending.err;
    EXPECT_THAT(ending.err, HasSubstr("PENUMBRA_DEVICE_TIMEOUT"));
  }
}

/// Waits on Mesa's software driver, whose threads do nothing in these tests.
class LongWaitFaults : public WaitFaults {};

TEST_F(LongWaitFaults, ADeviceThatDoesNothingIs4) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer starts the driver's threads: the library that makes them deaf sees none";
  const Ending ending = run_under(
      {.arguments = {"render", small_scene(), "-o", path("out.exr"), "--device", "cpu", "--method", "shadow-map"},
       .environment = {{"LD_PRELOAD", PENUMBRA_INTERPOSE}, {"PENUMBRA_FAULT_DEAF", "libvulkan_lvp"}}});
  EXPECT_EQ(ending.code, 4) << ending.err;
  EXPECT_THAT(ending.err, HasSubstr("has made no progress for"));
  EXPECT_THAT(files(), ElementsAre("scene.json"));
}

TEST_F(LongWaitFaults, CompareKeepsWhatCameBefore) {
  // The first method takes milliseconds, the second a minute in one submission.
  const Ending ending = run_under(
      {.arguments = {"compare", small_scene(), "-o", path("dir"), "--size", "512x512", "--light-samples", "4096",
                     "--reference", "exact", "--sample-pixels", "4", "--methods",
                     "shadow-map:size=64,depth-complexity:engine=vulkan,hard-volume", "--runs", "1", "--device", "cpu"},
       .environment = {{"LP_NUM_THREADS", "1"}, {"PENUMBRA_DEVICE_TIMEOUT", "2"}}});
  EXPECT_EQ(ending.code, 4) << ending.err;
  const std::string metrics = read("dir/metrics.json");
  EXPECT_THAT(metrics, HasSubstr("did not finish within 2 s"));
  EXPECT_THAT(metrics, HasSubstr("not run, since the device no longer answers"));
  EXPECT_TRUE(std::filesystem::exists(path("dir") + "/shadow-map,size=64.exr"));
  EXPECT_TRUE(std::filesystem::exists(path("dir") + "/report.html"));
}

}  // namespace
}  // namespace penumbra::tests
