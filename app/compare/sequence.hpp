// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/comparison/comparison.hpp"

#include <cstdint>
#include <span>

namespace penumbra::app {

/// Compares frame after frame of an animation, the last one with all of DIR's files, and writes metrics.json of the
/// sequence: errors over all frames' judged pixels, medians of seconds, flicker, and `frames`. Flicker is, over pixels
/// that are judged in a frame and in the previous one, the RMSE of the change of V less the reference's change. Throws
/// the same errors as compare_methods().
compare::Metrics compare_frames(const session::RunOptions& run, const session::ComparisonOptions& options,
                                std::span<const std::int64_t> frames, double fps,
                                const std::vector<std::string>& arguments, session::Progress& progress);

}  // namespace penumbra::app
