#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace penumbra::app {

/// A frame that could not be rendered, and why.
struct FailedFrame {
  std::int64_t frame = 0;
  int code = 0;        ///< an exit code of this program
  std::string reason;  ///< what the worker said of it
};

/// How frames are rendered: by processes that run `render`.
struct Workers {
  std::vector<std::string> command;  ///< the program, and all arguments but --frames
  std::int64_t step = 1;             ///< of the sequence
  std::size_t at_once = 1;
  std::function<bool(std::int64_t)> is_there;  ///< are all of the frame's files there?
  std::filesystem::path logs = {};             ///< folder of a log a frame (see FrameLogs); empty: none are kept
};

/// Renders frames (ascending) that are missing, and leaves out what is there, so that nothing is rendered twice. Where
/// a worker ends early, however it ends, its first missing frame is tried once more, alone, and those after it go to
/// the next worker. Returns the frames that failed again, ascending. What workers say goes to stderr, line by line.
/// Throws UsageError for a command line that cannot be meant, and Interrupted; then all workers have ended.
std::vector<FailedFrame> render_frames(const Workers& workers, const std::vector<std::int64_t>& frames);

}  // namespace penumbra::app
