// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/process/progress.hpp"

#include <chrono>
#include <cstdint>
#include <string>

namespace penumbra::app {

/// Shows a bar on stderr if stderr is a terminal, else a line every five seconds; neither with --quiet. Each step also
/// checks for an interrupt (Interrupted). Messages go to spdlog.
class TerminalProgress final : public Progress {
 public:
  explicit TerminalProgress(bool wanted);
  ~TerminalProgress() override;

  void begin(std::string stage, std::uint64_t steps) override;
  using Progress::advance;
  void advance(std::uint64_t steps) override;
  void clear() override;
  void say(Level level, const std::string& message) override;

 private:
  void draw();

  bool wanted_ = false, on_terminal_ = false;
  std::string stage_;
  std::uint64_t steps_ = 0, done_ = 0;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_draw_;
};

}  // namespace penumbra::app
