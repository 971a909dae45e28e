#include "app/view/live_pace.hpp"

#include <algorithm>
#include <array>

namespace penumbra::app {
namespace {

/// From the best down.
constexpr std::array kLevels{LiveQuality{1, 64}, LiveQuality{1, 16}, LiveQuality{2, 16},
                             LiveQuality{2, 4},  LiveQuality{4, 4},  LiveQuality{8, 4}};
constexpr double kQuickTime = 28;  // milliseconds, that leave time for more

}  // namespace

LiveQuality LivePace::quality() const {
  return kLevels.at(level_);
}

void LivePace::took(double milliseconds) {
  if (milliseconds > kPictureTime) {
    level_ = std::min(level_ + (milliseconds > 2 * kPictureTime ? 2 : 1), kLevels.size() - 1);
    quick_ = 0;
  } else if (milliseconds < kQuickTime && level_ > 0 && ++quick_ >= 4) {
    --level_;
    quick_ = 0;
  }
}

}  // namespace penumbra::app
