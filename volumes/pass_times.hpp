#pragma once

#include "visibility/method.hpp"

#include <algorithm>
#include <vector>

namespace penumbra::volumes {

/// Adds times to those of the same name, as Method::take_pass_times gives them.
inline void add_times(std::vector<visibility::PassTime>& sums, const std::vector<visibility::PassTime>& times) {
  for (const visibility::PassTime& time : times) {
    const auto sum = std::ranges::find(sums, time.name, &visibility::PassTime::name);
    if (sum == sums.end()) {
      sums.push_back(time);
    } else {
      sum->milliseconds += time.milliseconds;
    }
  }
}

}  // namespace penumbra::volumes
