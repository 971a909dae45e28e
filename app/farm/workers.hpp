// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace penumbra::app {

/// Frame that could not be rendered, with the reason.
struct FailedFrame {
  std::int64_t frame = 0;
  int code = 0;        ///< exit code of this program
  std::string reason;  ///< the worker's message
};

/// Worker processes, each running `render`.
struct Workers {
  std::vector<std::string> command;  ///< the program, and all arguments except --frames
  std::int64_t step = 1;             ///< of the sequence
  std::size_t at_once = 1;
  std::function<bool(std::int64_t)> is_there;  ///< whether all of the frame's files exist
  std::filesystem::path logs = {};             ///< folder with one log for each frame (see FrameLogs); empty: none are
                                               ///< kept
};

/// Renders missing frames (ascending), and skips existing ones, so that nothing is rendered twice. Where a worker ends
/// early, for any reason, its first missing frame is tried once more, alone, and the frames after it go to the next
/// worker. Returns the frames that failed again, ascending. Output of workers goes to stderr, line by line. Throws
/// UsageError for an invalid command line, and Interrupted; all workers have then ended.
std::vector<FailedFrame> render_frames(const Workers& workers, const std::vector<std::int64_t>& frames);

}  // namespace penumbra::app
