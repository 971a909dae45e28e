#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// Agrawala et al. 2000: how many light samples see each surface of a layered depth image. docs/layered-attenuation.md.
std::unique_ptr<visibility::Method> make_layered_attenuation(const render::Device& device,
                                                             const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription layered_attenuation_description();

}  // namespace penumbra::maps
