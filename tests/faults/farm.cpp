// SPDX-License-Identifier: Apache-2.0
// Tests sequences whose processes are killed: rendered frames stay, nothing is rendered twice, and no process is left.
#include "base/exr.hpp"
#include "tests/faults/child.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <map>
#include <thread>

#include <sys/stat.h>

namespace penumbra::tests {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

class FarmFaults : public FaultTest {
 protected:
  FarmFaults() { (void)small_scene(); }

  [[nodiscard]] std::vector<std::string> sequence(const std::string& command, std::vector<std::string> more,
                                                  const std::string& size = "192x128") const {
    std::vector<std::string> arguments = {command,    path("scene.json"), "--size",     size,
                                          "--method", "raytrace",         "--frames",   "1-8",
                                          "-o",       path("s.#.exr"),    "--exposure", "0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  struct Picture {
    ino_t file = 0;  // changes if the file is written again
    std::string bytes;
    bool operator==(const Picture&) const = default;
  };
  [[nodiscard]] std::map<std::string, Picture> pictures() const {
    std::map<std::string, Picture> all;
    for (const std::string& name : files()) {
      struct stat status {};
      if (!name.ends_with(".exr") || ::stat(path(name).c_str(), &status) != 0) continue;
      all[name] = {status.st_ino, read(name)};
    }
    return all;
  }
  /// Waits until this many pictures exist, or the program has ended.
  void wait_for_pictures(Running& program, std::size_t count) const {
    while (pictures().size() < count && !program.has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  /// Returns the running processes with this folder on their command line.
  [[nodiscard]] std::vector<pid_t> processes() const {
    std::vector<pid_t> all;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      std::ifstream file(entry.path() / "cmdline", std::ios::binary);  // empty for a process that has ended
      const std::string line{std::istreambuf_iterator<char>(file), {}};
      if (line.find(folder_.string()) != std::string::npos) all.push_back(std::stoi(entry.path().filename().string()));
    }
    return all;
  }
  void expect_nobody() const {
    for (int i = 0; i < 1000 && !processes().empty(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_THAT(processes(), testing::IsEmpty());
  }
  /// Expects all eight pictures, with those of `before` unchanged.
  void expect_whole(const std::map<std::string, Picture>& before) const {
    const auto now = pictures();
    EXPECT_EQ(now.size(), 8u);
    for (const auto& [name, picture] : now) {
      EXPECT_NO_THROW((void)read_exr(path(name))) << name;
      const auto old = before.find(name);
      if (old != before.end()) {
        EXPECT_EQ(old->second.file, picture.file) << name << " was rendered twice";
        EXPECT_EQ(old->second.bytes, picture.bytes) << name;
      }
    }
  }
};

TEST_F(FarmFaults, AKilledSequenceLosesItsCurrentFrameAtMost) {
  Running program({.arguments = sequence("render", {})});
  wait_for_pictures(program, 3);
  program.send(SIGKILL);
  const Ending killed = program.wait();
  ASSERT_EQ(killed.code, 137) << "too fast to be killed";
  const auto before = pictures();
  EXPECT_GE(before.size(), 3u);
  ASSERT_LT(before.size(), 8u);
  ASSERT_EQ(run_under({.arguments = sequence("render", {"--skip-existing"})}).code, 0);
  expect_whole(before);
}

TEST_F(FarmFaults, AKilledWorkersFramesAreRenderedByTheNext) {
  Running program({.arguments = sequence("submit", {"--jobs", "1"})});
  wait_for_pictures(program, 3);
  const std::optional<pid_t> worker = program.first_child();
  ASSERT_TRUE(worker) << "too fast to be killed";
  ::kill(*worker, SIGKILL);
  const auto before = pictures();
  const Ending ending = program.wait();
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(ending.err, HasSubstr("its worker was ended by signal 9; it is tried once more"));
  expect_whole(before);
  expect_nobody();
}

TEST_F(FarmFaults, AnInterruptEndsAllWorkers) {
  for (const int signal : {SIGINT, SIGTERM}) {
    Running program({.arguments = sequence("submit", {"--jobs", "2"})});
    wait_for_pictures(program, pictures().size() + 1);
    program.send(signal);
    const Ending ending = program.wait();
    EXPECT_EQ(ending.code, 130) << ending.err;
    EXPECT_THAT(ending.err, HasSubstr("interrupted"));
    expect_nobody();
    EXPECT_LT(pictures().size(), 8u);
  }
}

/// Workers end with the process that started them, so that the next run has the frames to itself.
TEST_F(FarmFaults, NoWorkerOutlivesAKill) {
  Running program({.arguments = sequence("submit", {"--jobs", "2"})});
  wait_for_pictures(program, 1);
  program.send(SIGKILL);
  EXPECT_EQ(program.wait().code, 137);
  expect_nobody();
  const auto before = pictures();
  EXPECT_LT(before.size(), 8u);
  EXPECT_EQ(run_under({.arguments = sequence("submit", {"--jobs", "2"})}).code, 0);
  expect_whole(before);
}

/// Workers cannot finish in the meantime: a frame takes half a minute here.
TEST_F(FarmFaults, NoWorkerFinishesItsFrameAfterAKill) {
  Running program({.arguments = sequence("submit", {"--jobs", "2", "--light-samples", "4096"}, "768x768")});
  while (processes().size() < 3 && !program.has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // until it is past its start
  program.send(SIGKILL);
  EXPECT_EQ(program.wait().code, 137);
  expect_nobody();
  EXPECT_TRUE(pictures().empty());
}

}  // namespace
}  // namespace penumbra::tests
