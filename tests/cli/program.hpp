// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::tests {

/// Exit code and output of a run of the program.
struct Outcome {
  int code = -1;  ///< exit code; 128 + signal if it was killed
  std::string out, err;
};

struct Invocation {
  std::vector<std::string> arguments;
  std::map<std::string, std::string> environment;  ///< in addition to the test's own and PENUMBRA_VALIDATION=1
  std::optional<double> interrupt_after;           ///< seconds until SIGINT
  double timeout = 120;                            ///< seconds until SIGKILL; then code is 137
};

/// Runs the program that was built with these tests.
Outcome run_program(const Invocation& invocation);

/// A test with its own empty folder, which is removed afterwards.
class ProgramTest : public testing::Test {
 protected:
  ProgramTest();
  ~ProgramTest() override;

  std::filesystem::path write(const std::string& name, const std::string& text) const;
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  /// All files in the folder, hidden ones too, relative and sorted.
  [[nodiscard]] std::vector<std::string> files() const;
  [[nodiscard]] std::string read(const std::string& name) const;

  /// A box on a floor under a square light, 48 × 32 pixels; it contains every kind of pixel.
  std::string tiny_scene() const;
  /// A second of animation: a body over a floor that its lamp shines down on, seen by two cameras from above.
  std::string moving_scene() const;
  Outcome run(std::vector<std::string> arguments, std::map<std::string, std::string> environment = {}) const;

  std::filesystem::path folder_;
};

/// The tiny scene with one member of its JSON (by pointer) replaced by other JSON text.
std::string scene_text_with(const std::string& pointer, const std::string& json);

}  // namespace penumbra::tests
