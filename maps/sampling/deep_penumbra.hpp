#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// St-Amour, Paquette and Poulin 2005: V as a function of depth in every texel. docs/deep-penumbra.md.
std::unique_ptr<visibility::Method> make_deep_penumbra(const render::Device& device,
                                                       const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription deep_penumbra_description();

}  // namespace penumbra::maps
