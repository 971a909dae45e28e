// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace penumbra::session {

/// Wall-clock time since construction or the last restart.
class Stopwatch {
 public:
  void restart() { start_ = std::chrono::steady_clock::now(); }
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace penumbra::session
