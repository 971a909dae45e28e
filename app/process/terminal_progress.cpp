// SPDX-License-Identifier: Apache-2.0
// Shows progress on stderr.

#include "app/process/terminal_progress.hpp"

#include "app/process/process.hpp"
#include "session/process/interrupt.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <system_error>
#include <utility>

#include <unistd.h>

namespace penumbra::app {

namespace {

/// Interval of lines if there is no bar; shorter stages print nothing.
constexpr auto kSilence = std::chrono::seconds(5);
/// Work that has taken this long may have long steps, which a thread then reports. Shorter work starts no thread, since
/// a process may be allowed only a few.
constexpr auto kShort = std::chrono::seconds(1);

}  // namespace

TerminalProgress::TerminalProgress(bool wanted)
    : wanted_(wanted),
      on_terminal_(::isatty(STDERR_FILENO) != 0),
      made_(std::chrono::steady_clock::now()),
      last_draw_(made_) {}

TerminalProgress::~TerminalProgress() {
  reporter_ = {};
  clear();
}

void TerminalProgress::begin(std::string stage, std::uint64_t steps) {
  session::check_interrupt();
  const std::scoped_lock lock(mutex_);
  stage_ = std::move(stage);
  began_ = std::chrono::steady_clock::now();
  steps_ = std::max<std::uint64_t>(steps, 1);
  done_ = 0;
  if (on_terminal_) last_draw_ = {};
  draw();
}

void TerminalProgress::advance(std::uint64_t steps) {
  session::check_interrupt();
  const std::scoped_lock lock(mutex_);
  done_ = std::min(done_ + steps, steps_);
  draw();
}

void TerminalProgress::clear() {
  if (!drawn_) return;
  app::say("\r\033[K");
  drawn_ = false;
}

void TerminalProgress::say(Level level, const std::string& message) {
  clear();
  constexpr std::array kLevels = {spdlog::level::debug, spdlog::level::info, spdlog::level::warn, spdlog::level::err};
  spdlog::log(kLevels.at(static_cast<std::size_t>(level)), "{}", message);
}

void TerminalProgress::draw() {
  if (!wanted_) return;
  const auto now = std::chrono::steady_clock::now();
  if (!on_terminal_) {
    if (now - last_draw_ >= kSilence) draw_line(now);
    if (!reporter_.joinable() && now - made_ >= kShort) begin_reporting();
    return;
  }
  if (now - last_draw_ < std::chrono::milliseconds(50) && done_ < steps_) return;  // a terminal is slower than a step
  last_draw_ = now;
  constexpr std::uint64_t kWidth = 30;
  const std::uint64_t filled = kWidth * done_ / steps_;
  app::say(fmt::format("\r\033[K[{}{}] {:3}% {}", std::string(filled, '='), std::string(kWidth - filled, ' '),
                       100 * done_ / steps_, stage_));
  drawn_ = true;
}

void TerminalProgress::draw_line(std::chrono::steady_clock::time_point now) {
  last_draw_ = now;
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(now - began_).count();
  app::say(fmt::format("penumbra: info: {:3}% {}{}\n", 100 * done_ / steps_, stage_,
                       seconds >= kSilence.count() ? fmt::format(", {} s", seconds) : ""));
}

void TerminalProgress::begin_reporting() {
  try {
    reporter_ = std::jthread([this](const std::stop_token& stop) { report_long_steps(stop); });
  } catch (const std::system_error&) {
    // No thread can be created: long steps are silent.
  }
}

void TerminalProgress::report_long_steps(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    stopped_.wait_for(lock, stop, kSilence / 2, [] { return false; });
    const auto now = std::chrono::steady_clock::now();
    if (!stop.stop_requested() && done_ < steps_ && now - last_draw_ >= kSilence) draw_line(now);
  }
}

}  // namespace penumbra::app
