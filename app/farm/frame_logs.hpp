// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/farm/workers.hpp"

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace penumbra::app {

/// Output of a worker, split into a log for each frame: Workers::logs/frame-0012.log. A frame that is tried again
/// continues its log. A log that cannot be written is left out, without failure of the frame.
class FrameLogs {
 public:
  /// `frames`: the worker's frames, in the order of rendering.
  FrameLogs(const Workers& workers, std::vector<std::int64_t> frames);
  /// Adds one line of the worker; lines are in order.
  void add(const std::string& line);

 private:
  /// Opens the log of frame `at_`.
  void begin();

  const Workers& workers_;
  std::vector<std::int64_t> frames_;
  bool says_when_done_;  ///< whether the worker prints a line after each picture
  std::size_t at_ = 0;   ///< index of the current frame
  std::ofstream log_;
};

/// Returns the path of a frame's log.
std::filesystem::path frame_log(const std::filesystem::path& folder, std::int64_t frame);

}  // namespace penumbra::app
