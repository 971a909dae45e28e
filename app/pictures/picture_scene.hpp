// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/options.hpp"
#include "app/pictures/frame_render.hpp"
#include "app/pictures/request.hpp"

#include <optional>

namespace penumbra::app {

/// Reads the scene at a time of its animation, at rest without a time; with the requested lens, and with copies of its
/// instances where the picture needs them (needs_copies). Throws UsageError, InputError or ResourceError.
PictureScene read_picture_scene(const RunOptions& run, std::optional<double> time, const PictureRequest& request);

}  // namespace penumbra::app
