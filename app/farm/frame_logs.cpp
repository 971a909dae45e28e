// SPDX-License-Identifier: Apache-2.0
// Splits a worker's output into logs of frames.

#include "app/farm/frame_logs.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <string_view>
#include <utility>

namespace penumbra::app {
namespace {

std::string node_name() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "?";
  return name.data();
}

/// Returns whether the line is "penumbra: info: NAME.exr: …": the last one about a picture, written after its files.
bool ends_a_picture(std::string_view line) {
  return line.starts_with("penumbra: info: ") && line.find(".exr: ") != std::string_view::npos;
}

}  // namespace

std::filesystem::path frame_log(const std::filesystem::path& folder, std::int64_t frame) {
  return folder / fmt::format("frame-{:04}.log", frame);
}

FrameLogs::FrameLogs(const Workers& workers, std::vector<std::int64_t> frames)
    : workers_(workers),
      frames_(std::move(frames)),
      says_when_done_(std::ranges::find(workers.command, "--quiet") == workers.command.end()) {
  if (!workers_.logs.empty()) begin();
}

void FrameLogs::begin() {
  log_.close();
  if (at_ >= frames_.size()) return;
  log_.open(frame_log(workers_.logs, frames_[at_]), std::ios::app);
  log_ << fmt::format("frame {} on {}, {:%F %T}\n", frames_[at_], node_name(), fmt::localtime(std::time(nullptr)))
       << std::flush;
}

void FrameLogs::add(const std::string& line) {
  if (workers_.logs.empty()) return;
  const auto go_on = [&] {
    // With several cameras, other pictures of the frame may still be missing.
    if (at_ >= frames_.size() || !workers_.is_there(frames_[at_])) return false;
    ++at_;
    begin();
    return true;
  };
  while (!says_when_done_ && go_on()) {
  }
  log_ << line << '\n' << std::flush;
  if (says_when_done_ && ends_a_picture(line)) go_on();
}

}  // namespace penumbra::app
