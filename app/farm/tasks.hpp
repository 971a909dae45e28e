// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/pictures/frames.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// Seconds of starting a process (start, reading the scene, the device, the mesh), and of each frame.
struct FrameCost {
  double begin = 0, frame = 0;
};

/// Returns the number of frames of one task, from 1 to 100,000: the least number with which a task runs for a minute (a
/// scheduler needs seconds to start it) and starting takes at most a tenth of its frames' time.
std::size_t frames_per_task(const FrameCost& cost);

/// Divides the missing frames of a sequence (ascending, `step` apart or a multiple of it) into runs of at most `size`,
/// or of more, if there would be more than `most` runs otherwise. All runs have the same number of missing frames, or
/// one more; each begins and ends with a missing frame. In between there may be existing frames.
std::vector<session::FrameRange> cut_into_tasks(std::span<const std::int64_t> missing, std::int64_t step,
                                                std::size_t size, std::size_t most);

/// Returns "A-BxN", in the form of --frames.
std::string text_of(const session::FrameRange& range);
/// Returns "3, 7-9", for messages; frames that are `step` apart are joined.
std::string list_of(std::span<const std::int64_t> frames, std::int64_t step);

}  // namespace penumbra::app
