#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// Fernando 2005: percentage-closer soft shadows on one map from the light's centre. docs/pcss.md.
std::unique_ptr<visibility::Method> make_pcss(const render::Device& device, const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription pcss_description();

}  // namespace penumbra::maps
