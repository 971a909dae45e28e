#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// Schwärzler: shadow maps from points of the light that are added where two maps differ. docs/adaptive-light.md.
std::unique_ptr<visibility::Method> make_adaptive_light(const render::Device& device,
                                                        const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription adaptive_light_description();

}  // namespace penumbra::maps
