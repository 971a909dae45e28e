// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/process/progress.hpp"

#include <set>
#include <string>
#include <utility>

namespace penumbra::app {

/// Passes everything on, but each message only once: for work that repeats the same steps.
class SayOnce final : public session::Progress {
 public:
  explicit SayOnce(session::Progress& progress) : progress_(progress) {}

  void begin(std::string stage, std::uint64_t steps) override { progress_.begin(std::move(stage), steps); }
  using session::Progress::advance;
  void advance(std::uint64_t steps) override { progress_.advance(steps); }
  void clear() override { progress_.clear(); }
  void say(Level level, const std::string& message) override {
    if (said_.insert(message).second) progress_.say(level, message);
  }

 private:
  session::Progress& progress_;
  std::set<std::string> said_;
};

}  // namespace penumbra::app
