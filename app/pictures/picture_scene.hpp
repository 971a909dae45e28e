// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/options.hpp"
#include "app/pictures/request.hpp"
#include "scenes/instances.hpp"
#include "scenes/scene.hpp"

#include <optional>

namespace penumbra::app {

/// Scene of a picture, and the time of reading it.
struct PictureScene {
  scenes::Scene scene;
  scenes::Instances instances = {};  ///< those that stay without copies; Frame::instances
  double seconds = 0;
};

/// Reads the scene at a time of its animation, at rest without a time; with the requested lens, and with copies of its
/// instances where the picture needs them (needs_copies). Throws UsageError, InputError or ResourceError.
PictureScene read_picture_scene(const RunOptions& run, std::optional<double> time, const PictureRequest& request);

/// Reads the scene of one of several moments of a picture, which all have copies.
scenes::Scene read_moment(const RunOptions& run, std::optional<double> time, const PictureRequest& request);

}  // namespace penumbra::app
