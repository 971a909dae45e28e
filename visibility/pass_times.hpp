// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::visibility {

/// Time of a GPU pass, or of a stage on the processor.
struct PassTime {
  std::string name;
  double milliseconds = 0;
};

/// Sums of times with equal names, in the order of first occurrence.
class PassTimes {
 public:
  void add(const PassTime& time) {
    const auto sum = std::ranges::find(sums_, time.name, &PassTime::name);
    if (sum == sums_.end()) {
      sums_.push_back(time);
    } else {
      sum->milliseconds += time.milliseconds;
    }
  }
  void add(const std::vector<PassTime>& times) {
    for (const PassTime& time : times) add(time);
  }
  /// Adds the duration of `work`, and returns its result.
  template <typename Work>
  auto add(const std::string& name, Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    auto result = std::forward<Work>(work)();
    add({name, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count()});
    return result;
  }
  /// Returns the times added since the last call.
  std::vector<PassTime> take() { return std::exchange(sums_, {}); }

 private:
  std::vector<PassTime> sums_;
};

}  // namespace penumbra::visibility
