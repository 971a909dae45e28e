#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// Williams 1978: the hard shadow from the light's centre. docs/shadow-map.md.
std::unique_ptr<visibility::Method> make_shadow_map(const render::Device& device,
                                                    const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription shadow_map_description();

}  // namespace penumbra::maps
