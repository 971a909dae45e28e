#pragma once

#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <span>

namespace penumbra::app {

/// The view samples of a few pixels (y · width + x), found without a device: all others are left background. Tries
/// every triangle at each of them, in parallel over pixels.
visibility::ViewSamples samples_at(const visibility::SceneFloats& scene, const visibility::PinholeCamera& camera,
                                   std::span<const std::uint32_t> pixels);

}  // namespace penumbra::app
