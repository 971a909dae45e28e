#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::visibility {

/// A GPU pass, or a stage on the processor, and how long it took.
struct PassTime {
  std::string name;
  double milliseconds = 0;
};

/// Sums of those of the same name, in the order in which they first came.
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
  /// Adds how long `work` takes, and returns what it does.
  template <typename Work>
  auto add(const std::string& name, Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    auto result = std::forward<Work>(work)();
    add({name, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count()});
    return result;
  }
  /// What was added since the last call.
  std::vector<PassTime> take() { return std::exchange(sums_, {}); }

 private:
  std::vector<PassTime> sums_;
};

}  // namespace penumbra::visibility
