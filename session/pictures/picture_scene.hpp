// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/formats/scenes_ahead.hpp"
#include "session/options.hpp"
#include "session/pictures/frame_render.hpp"
#include "session/pictures/request.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace penumbra::session {

/// Reads the scene at a time of its animation, at rest without a time; with the requested lens, and with copies of its
/// instances where the picture needs them (needs_copies). `ahead`: other times at which the scene will be wanted
/// (ReadOptions::ahead); null: none. Throws UsageError, InputError or ResourceError.
PictureScene read_picture_scene(const RunOptions& run, std::optional<double> time, const PictureRequest& request,
                                scenes::ScenesAhead* ahead = nullptr);

/// Returns functions that return the scenes in the files of --moment, for Frame::moments: to be called in their order,
/// once each. While the caller works on one scene, a separate process reads the next file, so that memory holds two.
/// `own`: SCENE as it was read; its origin becomes that of all moments, so that objects at rest have the same scene
/// floats in each. The other arguments must outlive the functions, which throw as read_picture_scene() does.
std::vector<std::function<PictureScene()>> moments_in_files(const PictureOptions& options,
                                                            const PictureRequest& request, PictureScene& own);

}  // namespace penumbra::session
