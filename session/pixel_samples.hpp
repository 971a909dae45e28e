// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <span>

namespace penumbra::session {

/// Returns the view samples of a few pixels (y · width + x), found without a device: all others are background. Tests
/// every triangle at each of these pixels, in parallel over pixels.
visibility::ViewSamples samples_at(const visibility::SceneFloats& scene, const visibility::PinholeCamera& camera,
                                   std::span<const std::uint32_t> pixels);

}  // namespace penumbra::session
