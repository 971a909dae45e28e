#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// Bavoil, Callahan and Silva 2006: several layers of one map, projected back onto the light. docs/backproject-peel.md.
std::unique_ptr<visibility::Method> make_backproject_peel(const render::Device& device,
                                                          const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription backproject_peel_description();

}  // namespace penumbra::maps
