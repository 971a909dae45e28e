// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/process/progress.hpp"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

namespace penumbra::app {

/// Shows a bar on stderr if stderr is a terminal, else a line every five seconds, also during a long step. With
/// --quiet it shows neither. Each step also checks for an interrupt (Interrupted). Messages go to spdlog.
class TerminalProgress final : public session::Progress {
 public:
  explicit TerminalProgress(bool wanted);
  ~TerminalProgress() override;

  void begin(std::string stage, std::uint64_t steps) override;
  using session::Progress::advance;
  void advance(std::uint64_t steps) override;
  void clear() override;
  void say(Level level, const std::string& message) override;

 private:
  void draw();
  void draw_line(std::chrono::steady_clock::time_point now);
  void begin_reporting();
  /// Writes a line wherever nothing was written for a while; runs until the destructor.
  void report_long_steps(const std::stop_token& stop);

  bool wanted_ = false, on_terminal_ = false;
  std::string stage_;
  std::uint64_t steps_ = 0, done_ = 0;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point made_, last_draw_, began_;
  std::mutex mutex_;  // guards the members above
  std::condition_variable_any stopped_;
  std::jthread reporter_;  // only where there is no terminal, and for work that is not short
};

}  // namespace penumbra::app
