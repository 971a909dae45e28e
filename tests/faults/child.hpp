// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sys/resource.h>
#include <sys/types.h>

namespace penumbra::tests {

/// Whether this is a build with a sanitizer, which has needs of its own: terabytes of address space, a pipe to ask
/// whether memory can be read, and starting the threads of libraries. Tests that take these away then say nothing about
/// the program.
#if defined(PENUMBRA_SHADOW_MEMORY)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// Kinds of a standard stream of the program.
enum class Stream {
  captured,
  closed,
  full,         ///< /dev/full: every write fails
  broken_pipe,  ///< a pipe that nobody reads
};

struct Limit {
  __rlimit_resource resource;
  rlim_t value;
};

/// A run of the program under adverse conditions.
struct Conditions {
  std::vector<std::string> arguments;
  std::map<std::string, std::string> environment = {};  ///< in addition to the test's own
  std::vector<Limit> limits = {};
  Stream in = Stream::captured, out = Stream::captured, err = Stream::captured;
  bool as_stranger = false;  ///< as a user without other processes, if the test runs as root: for RLIMIT_NPROC
  double timeout = 300;      ///< seconds until SIGKILL, which no test expects; the code is then 137
};

struct Ending {
  int code = -1;  ///< exit code; 128 + signal if it was ended by one
  std::string out, err;
  std::uint64_t peak_bytes = 0;  ///< resident memory of the program, or of a child that it waited for
};

/// Returns whether this is a documented exit code.
bool is_documented(int code);

/// A program that was started and is not waited for; it is killed with this object.
class Running {
 public:
  explicit Running(const Conditions& conditions);
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running();

  [[nodiscard]] pid_t pid() const { return pid_; }
  void send(int signal) const { ::kill(pid_, signal); }
  [[nodiscard]] bool has_ended();
  /// Reads the program's output until it ends.
  Ending wait();
  /// Returns the program's first child, found by polling, or nullopt if it ends without one.
  std::optional<pid_t> first_child();

 private:
  void reap(int options);
  pid_t pid_ = -1;
  int out_ = -1, err_ = -1;
  double timeout_ = 0;
  std::optional<int> status_;
  rusage usage_{};
};

Ending run_under(const Conditions& conditions);

/// A test with its own empty folder that anybody may write to, removed afterwards.
class FaultTest : public testing::Test {
 protected:
  FaultTest();
  ~FaultTest() override;

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const;
  [[nodiscard]] std::string read(const std::string& name) const;
  /// All files in the folder, hidden ones too, relative and sorted.
  [[nodiscard]] std::vector<std::string> files() const;
  /// Two triangles over a floor under a square light, 48 × 32 pixels.
  [[nodiscard]] std::string small_scene(const std::string& name = "scene.json") const;
  /// A scene as above, with a mesh file beside it that keeps its reader busy for a while.
  [[nodiscard]] std::string slow_scene(int faces = 60'000) const;

  std::filesystem::path folder_;
};

}  // namespace penumbra::tests
