#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// Heckbert and Herf 1997: one shadow map a light sample. docs/accumulate.md.
std::unique_ptr<visibility::Method> make_accumulate(const render::Device& device,
                                                    const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription accumulate_description();

}  // namespace penumbra::maps
