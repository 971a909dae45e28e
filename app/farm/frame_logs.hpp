#pragma once

#include "app/farm/workers.hpp"

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace penumbra::app {

/// What a worker says, parted into a log for each frame that it renders: Workers::logs/frame-0012.log. A frame that is
/// tried again goes on in its log. Logs that cannot be written are left out: no frame fails for them.
class FrameLogs {
 public:
  /// `frames`: those that the worker was given, in the order in which it renders them.
  FrameLogs(const Workers& workers, std::vector<std::int64_t> frames);
  /// One line of the worker's, in their order.
  void add(const std::string& line);

 private:
  /// Opens the log of frame `at_`.
  void begin();

  const Workers& workers_;
  std::vector<std::int64_t> frames_;
  bool says_when_done_;  ///< is there a line at a picture's end?
  std::size_t at_ = 0;   ///< which of the frames it works on
  std::ofstream log_;
};

/// Where a frame's log is.
std::filesystem::path frame_log(const std::filesystem::path& folder, std::int64_t frame);

}  // namespace penumbra::app
