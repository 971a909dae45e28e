#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace penumbra::app {

/// A bar on stderr if that is a terminal, else a line every five seconds; neither if the user asked for quiet. Each
/// step also looks for an interrupt, so that whatever reports progress can be stopped.
class Progress {
 public:
  explicit Progress(bool wanted);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Starts a stage of `steps` steps; the one before is wiped away.
  void begin(std::string stage, std::uint64_t steps);
  /// Throws Interrupted after SIGINT.
  void advance(std::uint64_t steps = 1);
  void clear();

 private:
  void draw();

  bool wanted_ = false, on_terminal_ = false;
  std::string stage_;
  std::uint64_t steps_ = 0, done_ = 0;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_draw_;
};

}  // namespace penumbra::app
