#pragma once

#include "app/pictures/frames.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// Seconds of a process's first frame: what it costs to begin (starting, reading the scene, the device, the mesh), and
/// what each frame costs.
struct FrameCost {
  double begin = 0, frame = 0;
};

/// How many frames one task should have, from one to 100,000: the least number with which it works for a minute (what a
/// scheduler takes to start it is seconds) and beginning is at most a tenth of its frames' time.
std::size_t frames_per_task(const FrameCost& cost);

/// Cuts the missing frames of a sequence (ascending, `step` apart or a multiple of it) into runs of at most `size`, or
/// of more, where there would be more than `most` runs otherwise. All runs have the same number of missing frames, or
/// one more; each begins and ends with one. In between there may be frames that are there.
std::vector<FrameRange> cut_into_tasks(std::span<const std::int64_t> missing, std::int64_t step, std::size_t size,
                                       std::size_t most);

/// "A-BxN", as --frames takes it.
std::string text_of(const FrameRange& range);
/// For people: "3, 7-9"; those that are `step` apart are together.
std::string list_of(std::span<const std::int64_t> frames, std::int64_t step);

}  // namespace penumbra::app
