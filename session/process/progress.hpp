// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace penumbra::session {

/// Receiver of reports from long work; can also stop the work.
class Progress {
 public:
  enum class Level : std::uint8_t { debug, info, warning, error };

  Progress() = default;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  virtual ~Progress() = default;

  /// Starts a stage of `steps` steps, which ends the previous one.
  virtual void begin(std::string stage, std::uint64_t steps) = 0;
  /// Reports completed steps. Throws an Error to stop the work.
  virtual void advance(std::uint64_t steps) = 0;
  void advance() { advance(1); }
  /// Removes the display of the stage, so that other text can be written.
  virtual void clear() = 0;
  /// Reports one message, without a line break at its end.
  virtual void say(Level level, const std::string& message) = 0;
  void debug(const std::string& message) { say(Level::debug, message); }
  void info(const std::string& message) { say(Level::info, message); }
  void warn(const std::string& message) { say(Level::warning, message); }
  void error(const std::string& message) { say(Level::error, message); }
};

}  // namespace penumbra::session
