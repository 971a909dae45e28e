// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/formats/scenes_ahead.hpp"
#include "session/options.hpp"
#include "session/pictures/frame_render.hpp"
#include "session/pictures/request.hpp"

#include <optional>

namespace penumbra::session {

/// Reads the scene at a time of its animation, at rest without a time; with the requested lens, and with copies of its
/// instances where the picture needs them (needs_copies). `ahead`: other times at which the scene will be wanted
/// (ReadOptions::ahead); null: none. Throws UsageError, InputError or ResourceError.
PictureScene read_picture_scene(const RunOptions& run, std::optional<double> time, const PictureRequest& request,
                                scenes::ScenesAhead* ahead = nullptr);

}  // namespace penumbra::session
