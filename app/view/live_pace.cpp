// SPDX-License-Identifier: Apache-2.0
// Adapts the quality of live pictures to the time they take.

#include "app/view/live_pace.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace penumbra::app {
namespace {

/// Levels from the best to the lowest.
constexpr std::array kLevels{LiveQuality{1, 64}, LiveQuality{1, 16}, LiveQuality{2, 16},
                             LiveQuality{2, 4},  LiveQuality{4, 4},  LiveQuality{8, 4}};

/// Milliseconds; after a picture that takes longer, the next one has the lowest quality.
constexpr double kSlowTime = 8 * kPictureTime;

constexpr int kLongestPatience = 256;  // in pictures

}  // namespace

void SlowMethods::took(const std::string& entry, double milliseconds, bool lowest) {
  if (!lowest || milliseconds <= kPictureTime) {
    once_.erase(entry);
  } else if (!once_.insert(entry).second) {
    entries_.insert(entry);
  }
}

void SlowMethods::took_final(const std::string& entry, double milliseconds) {
  if (milliseconds > kPictureTime) return;
  entries_.erase(entry);
  once_.erase(entry);
}

void SlowMethods::clear() {
  entries_.clear();
  once_.clear();
}

LiveQuality LivePace::quality() const {
  return kLevels.at(level_);
}

bool LivePace::is_lowest() const {
  return level_ + 1 == kLevels.size();
}

/// A level that was too slow is tried again after twice as many quick pictures as before.
void LivePace::took(double milliseconds) {
  const bool was_raised = std::exchange(raised_, false);
  if (milliseconds > kPictureTime) {
    const std::size_t steps = was_raised                        ? 1
                              : milliseconds > kSlowTime        ? kLevels.size()
                              : milliseconds > 2 * kPictureTime ? 2
                                                                : 1;
    level_ = std::min(level_ + steps, kLevels.size() - 1);
    patience_ = was_raised ? std::min(2 * patience_, kLongestPatience) : patience_;
    quick_ = 0;
    return;
  }
  if (was_raised) patience_ = kPatience;
  if (milliseconds >= kQuickTime || level_ == 0 || ++quick_ < patience_) return;
  --level_;
  raised_ = true;
  quick_ = 0;
}

}  // namespace penumbra::app
