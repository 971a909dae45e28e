#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// Guennebaud, Barthe and Paulin 2006: texels of one map, projected back onto the light. docs/backproject.md.
std::unique_ptr<visibility::Method> make_backproject(const render::Device& device,
                                                     const visibility::MethodOptions& options);

/// What these options make of it; needs no device. Spheres (form=sphere) do sphere lights, too, and no textures.
visibility::MethodDescription backproject_description(const visibility::MethodOptions& options = {});

}  // namespace penumbra::maps
