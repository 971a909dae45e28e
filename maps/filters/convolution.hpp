#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// Soler and Sillion 1998: one picture of all blockers, convolved with the light. docs/convolution.md.
std::unique_ptr<visibility::Method> make_convolution(const render::Device& device,
                                                     const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription convolution_description();

}  // namespace penumbra::maps
