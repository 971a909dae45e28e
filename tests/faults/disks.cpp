// SPDX-License-Identifier: Apache-2.0
// Tests a disk that fails, or a process that is killed, at any of its calls: each output is the old file, the whole new
// one, or absent; the exit code is 0 or 4; and nothing is left over, at the latest after the next run.
#include "tests/faults/child.hpp"

#include <gmock/gmock.h>

#include <cerrno>
#include <cstring>

namespace penumbra::tests {
namespace {

using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

struct DiskFault {
  const char* call;
  int error;  ///< 0: the process is killed at this call
  bool named_parts;
};

std::ostream& operator<<(std::ostream& stream, const DiskFault& fault) {
  return stream << fault.call << ": " << (fault.error == 0 ? "killed" : std::strerror(fault.error))
                << (fault.named_parts ? ", named parts" : "");
}

class DiskFaults : public FaultTest, public testing::WithParamInterface<DiskFault> {
 protected:
  [[nodiscard]] Conditions job() const {
    return {.arguments = {"render", path("scene.json"), "-o", path("out.exr"), "--png", path("old.png"), "--bits",
                          path("out.bits"), "--stats", path("stats.json"), "--quiet"}};
  }
  [[nodiscard]] Ending run_with_fault(int at) const {
    const DiskFault& fault = GetParam();
    Conditions conditions = job();
    conditions.environment = {{"LD_PRELOAD", PENUMBRA_INTERPOSE},
                              {"PENUMBRA_FAULT_CALL", fault.call},
                              {"PENUMBRA_FAULT_AT", std::to_string(at)},
                              {"PENUMBRA_FAULT_ERRNO", std::to_string(fault.error)}};
    if (fault.named_parts) conditions.environment["PENUMBRA_TEST_NAMED_PARTS"] = "1";
    return run_under(conditions);
  }
  void expect_no_parts(const std::string& when) const {
    for (const std::string& file : files()) EXPECT_THAT(file, Not(HasSubstr(".part"))) << when;
  }
};

TEST_P(DiskFaults, EachOutputIsOldOrWholeOrNotThere) {
  (void)small_scene();
  ASSERT_EQ(run_under(job()).code, 0);
  std::map<std::string, std::string> right;
  for (const char* name : {"out.exr", "old.png", "out.bits"}) right[name] = read(name);
  const int failed = GetParam().error == 0 ? 137 : 4;
  int faults = 0;
  for (int at = 1;; ++at) {
    ASSERT_LT(at, 1000) << "it never succeeds";
    for (const char* name : {"out.exr", "out.bits", "stats.json"}) std::filesystem::remove(folder_ / name);
    write("old.png", "old");
    const Ending ending = run_with_fault(at);
    const std::string when = std::string(GetParam().call) + " " + std::to_string(at);
    EXPECT_THAT(ending.code, AnyOf(0, failed)) << when << ": " << ending.err;
    for (const auto& [name, content] : right) {
      if (!std::filesystem::exists(folder_ / name)) {
        EXPECT_NE(ending.code, 0) << when << ": " << name << " is not there";
      } else if (name != "old.png" || read(name) != "old" || ending.code == 0) {
        EXPECT_TRUE(read(name) == content) << when << ": " << name << " is torn";
      }
    }
    // If there is no room for one output, none appears.
    if (GetParam().error != 0 && std::string(GetParam().call) == "write" && ending.code != 0) {
      for (const char* name : {"out.exr", "out.bits", "stats.json"})
        EXPECT_FALSE(std::filesystem::exists(folder_ / name)) << when << ": " << name;
      EXPECT_EQ(read("old.png"), "old") << when;
    }
    if (GetParam().error == 0) {
      ASSERT_EQ(run_under({.arguments = {"convert", path("scene.json"), "-o", path("copy.obj")}}).code, 0);
    }
    expect_no_parts(when);
    if (ending.code == 0 && ++faults > 0) break;
    ++faults;
  }
  // A call failed in every run but the last, which succeeded.
  EXPECT_GT(faults, 1) << "no call ever failed";
}

INSTANTIATE_TEST_SUITE_P(Some, DiskFaults,
                         testing::Values(DiskFault{"write", ENOSPC, false}, DiskFault{"rename", EIO, true},
                                         DiskFault{"write", 0, true}, DiskFault{"rename", 0, false}));
INSTANTIATE_TEST_SUITE_P(Long, DiskFaults,
                         testing::Values(DiskFault{"write", EIO, true}, DiskFault{"fsync", EIO, false},
                                         DiskFault{"linkat", EPERM, false}, DiskFault{"rename", EIO, false},
                                         DiskFault{"open", ENOSPC, true}, DiskFault{"write", 0, false},
                                         DiskFault{"fsync", 0, false}, DiskFault{"linkat", 0, false},
                                         DiskFault{"rename", 0, true}));

}  // namespace
}  // namespace penumbra::tests
