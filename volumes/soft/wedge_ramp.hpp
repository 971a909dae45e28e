#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::volumes {

/// Akenine-Möller and Assarsson 2002: a linear ramp across each penumbra wedge. docs/wedge-ramp.md.
std::unique_ptr<visibility::Method> make_wedge_ramp(const render::Device& device,
                                                    const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription wedge_ramp_description();

}  // namespace penumbra::volumes
