// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/method_options.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <vector>

namespace penumbra::maps {

/// Returns MethodDescription::texel_widths of methods with the option `size`: for a map from the light's centre that
/// holds all receivers, which approximates every method without fitted maps. Geometric mean of a texel's two sides.
/// Empty for suns, spheres and other fits.
std::vector<float> texel_widths(const visibility::SceneFloats& scene, const visibility::ViewSamples& samples,
                                const visibility::Light& light, const visibility::MethodOptions& complete);

}  // namespace penumbra::maps
