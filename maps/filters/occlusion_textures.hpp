#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// Eisemann and Décoret 2006: casters in slices parallel to the light, each a picture filtered by the light's box.
/// docs/occlusion-textures.md.
std::unique_ptr<visibility::Method> make_occlusion_textures(const render::Device& device,
                                                            const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription occlusion_textures_description();

}  // namespace penumbra::maps
