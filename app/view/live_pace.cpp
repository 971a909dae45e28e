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
constexpr double kQuickTime = 20;  // milliseconds; a faster picture leaves time for a better level

constexpr int kLongestPatience = 256;  // in pictures

}  // namespace

LiveQuality LivePace::quality() const {
  return kLevels.at(level_);
}

/// A level that was too slow is tried again after twice as many quick pictures as before.
void LivePace::took(double milliseconds) {
  const bool was_raised = std::exchange(raised_, false);
  if (milliseconds > kPictureTime) {
    level_ = std::min(level_ + (milliseconds > 2 * kPictureTime && !was_raised ? 2 : 1), kLevels.size() - 1);
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
