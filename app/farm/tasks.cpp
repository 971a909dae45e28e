// SPDX-License-Identifier: Apache-2.0
// Divides missing frames into tasks.

#include "app/farm/tasks.hpp"

#include "base/assert.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::app {

std::size_t frames_per_task(const FrameCost& cost) {
  constexpr double kLeastSeconds = 60, kBeginningsShare = 0.1;
  constexpr double kMost = 100'000;  // largest length of a sequence; avoids division by a frame's time of 0
  const double seconds = std::max(kLeastSeconds - cost.begin, cost.begin / kBeginningsShare);
  if (!(seconds < kMost * cost.frame)) return static_cast<std::size_t>(kMost);
  return static_cast<std::size_t>(std::max(1.0, std::ceil(seconds / cost.frame)));
}

std::vector<session::FrameRange> cut_into_tasks(std::span<const std::int64_t> missing, std::int64_t step,
                                                std::size_t size, std::size_t most) {
  PENUMBRA_ASSERT(size > 0 && most > 0, "tasks of no frames, or none");
  const std::size_t count = std::min(most, (missing.size() + size - 1) / size);
  std::vector<session::FrameRange> tasks;
  for (std::size_t task = 0; task < count; ++task) {
    const std::size_t begin = task * missing.size() / count, end = (task + 1) * missing.size() / count;
    tasks.push_back({missing[begin], missing[end - 1], step});
  }
  return tasks;
}

std::string text_of(const session::FrameRange& range) {
  return fmt::format("{}-{}x{}", range.first, range.last, range.step);
}

std::string list_of(std::span<const std::int64_t> frames, std::int64_t step) {
  std::string text;
  for (std::size_t first = 0, next = 0; first < frames.size(); first = next) {
    while (++next < frames.size() && frames[next] == frames[next - 1] + step) {
    }
    text += fmt::format("{}{}", first > 0 ? ", " : "", frames[first]);
    if (next - first > 1) text += fmt::format("-{}", frames[next - 1]);
  }
  return text;
}

}  // namespace penumbra::app
