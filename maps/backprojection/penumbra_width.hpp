// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// Makes a method whose result at each view sample is the width of the narrowest possible penumbra there, in scene
/// units parallel to the light: the penumbra of the occluder in the sample's kernel that is farthest from the light
/// (penumbra_width.comp). Infinity: nothing in the kernel hides light. `options`: those of a method with a map from the
/// light's centre; others are ignored.
std::unique_ptr<visibility::Method> make_penumbra_widths(const render::Device& device,
                                                         const visibility::MethodOptions& options);

}  // namespace penumbra::maps
