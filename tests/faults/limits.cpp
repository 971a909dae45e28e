// SPDX-License-Identifier: Apache-2.0
// Tests resource limits that are too low for the work, for part of it, or for anything: exit code 0 or 4, a message
// that names the cause, no hang, and nothing left behind.
#include "tests/faults/child.hpp"

#include <gmock/gmock.h>

namespace penumbra::tests {
namespace {

using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kAsRoot = "the limit counts all processes of the user; run it as root, who can be a new one";

class LimitFaults : public FaultTest {
 protected:
  /// Checks everything that must hold for a limited run, whatever the limit; returns its exit code.
  int check(const Conditions& conditions, const std::string& what) const {
    const Ending ending = run_under(conditions);
    EXPECT_THAT(ending.code, AnyOf(0, 4)) << what << ": " << ending.err;
    EXPECT_THAT(ending.err, Not(HasSubstr("internal"))) << what;
    EXPECT_THAT(ending.err, Not(HasSubstr("terminate called"))) << what;
    if (ending.code != 0) {
      EXPECT_THAT(ending.err, HasSubstr("error: ")) << what;
      EXPECT_THAT(files(), ElementsAre("scene.json")) << what;
    }
    for (const std::string& file : files()) {
      EXPECT_THAT(file, Not(HasSubstr(".part"))) << what;
      if (file != "scene.json") std::filesystem::remove(folder_ / file);
    }
    return ending.code;
  }
  [[nodiscard]] std::vector<std::string> render() const {
    return {"render", path("scene.json"), "-o", path("out.exr"), "--png", path("out.png")};
  }
};

TEST_F(LimitFaults, FilesThatMayNotGrow) {
  (void)small_scene();
  for (const rlim_t bytes : {0ul, 1ul, 512ul, 4096ul, 8192ul, 1ul << 20}) {
    if (kSanitized && bytes == 0) continue;  // ThreadSanitizer writes a file at its own start
    const int code = check({.arguments = render(), .limits = {{RLIMIT_FSIZE, bytes}}}, std::to_string(bytes));
    EXPECT_EQ(code, bytes < (1 << 20) ? 4 : 0) << bytes;
  }
  const Ending ending = run_under({.arguments = render(), .limits = {{RLIMIT_FSIZE, 4096}}});
  EXPECT_THAT(ending.err, HasSubstr("File too large"));
}

TEST_F(LimitFaults, AComparisonWhoseFilesMayNotGrow) {
  (void)small_scene();
  const Ending ending = run_under(
      {.arguments = {"compare", path("scene.json"), "-o", path("dir"), "--methods", "raytrace", "--runs", "1"},
       .limits = {{RLIMIT_FSIZE, 8192}}});
  EXPECT_EQ(ending.code, 4) << ending.err;
  EXPECT_THAT(files(), ElementsAre("scene.json"));
}

TEST_F(LimitFaults, FewThreads) {
  if (::geteuid() != 0) GTEST_SKIP() << kAsRoot;
  (void)small_scene();
  const auto limited = [&](rlim_t threads, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = render();
    arguments.insert(arguments.end(), more.begin(), more.end());
    return check({.arguments = arguments, .limits = {{RLIMIT_NPROC, threads}}, .as_stranger = true},
                 std::to_string(threads) + " threads");
  };
  for (rlim_t threads = 1; threads <= 12; ++threads) limited(threads);
  EXPECT_EQ(limited(1), 4);
  EXPECT_EQ(limited(4), 0);
  EXPECT_EQ(limited(4, {"--method", "pcf"}), 4);  // too few for the driver's threads
  EXPECT_EQ(limited(500), 0);
}

TEST_F(LimitFaults, FewThreadsForTheImportHelper) {
  if (::geteuid() != 0) GTEST_SKIP() << kAsRoot;
  const std::string scene = slow_scene();
  for (rlim_t threads = 1; threads <= 4; ++threads) {
    const Ending ending = run_under({.arguments = {"convert", scene, "-o", path("out.obj")},
                                     .limits = {{RLIMIT_NPROC, threads}},
                                     .as_stranger = true});
    EXPECT_THAT(ending.code, AnyOf(0, 4)) << ending.err;
    EXPECT_THAT(ending.err, Not(HasSubstr("PENUMBRA_IMPORT_HELPER"))) << "the helper is there";
  }
}

TEST_F(LimitFaults, FewDescriptors) {
  (void)small_scene();
  for (const rlim_t files : {4ul, 5ul, 6ul, 8ul, 10ul, 12ul, 16ul, 20ul, 64ul}) {
    if (kSanitized && files < 8) continue;  // UBSan needs a pipe to learn whether memory can be read
    const Conditions conditions{.arguments = render(), .limits = {{RLIMIT_NOFILE, files}}};
    // Files that this test itself has open may leave too few descriptors to load the program: then the program gives no
    // answer to check.
    if (files < 8 && run_under(conditions).err.find("while loading shared libraries") != std::string::npos) continue;
    check(conditions, std::to_string(files) + " descriptors");
  }
}

TEST_F(LimitFaults, FewAddresses) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer takes terabytes of addresses when it starts";
  (void)small_scene();
  for (const rlim_t mebibytes : {200ul, 300ul, 400ul, 500ul, 600ul, 800ul, 1200ul}) {
    check({.arguments = render(), .limits = {{RLIMIT_AS, mebibytes << 20}}}, std::to_string(mebibytes) + " MiB");
  }
}

}  // namespace
}  // namespace penumbra::tests
