// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

/// Factory and description of each method. Descriptions are callable without a Vulkan device.
namespace penumbra::maps {

/// Makes `bitmask` (Schwarz and Stamminger 2007): the light samples hidden by texels of one map, as bits.
/// docs/bitmask.md.
std::unique_ptr<visibility::Method> make_bitmask(const render::Device& device,
                                                 const visibility::MethodOptions& options);

/// Returns the description with `options`, by default without any. Callable without a Vulkan device. If few pixels are
/// evaluated (option `subsample`), the method returns V alone.
visibility::MethodDescription bitmask_description(const visibility::MethodOptions& options = {});

/// Makes `backproject` (Guennebaud, Barthe and Paulin 2006): texels of one map, projected back onto the light.
/// docs/backproject.md.
std::unique_ptr<visibility::Method> make_backproject(const render::Device& device,
                                                     const visibility::MethodOptions& options);

/// Returns the description with `options`. Callable without a Vulkan device. With form=sphere, sphere lights are also
/// supported, and textures are not.
visibility::MethodDescription backproject_description(const visibility::MethodOptions& options = {});

/// Makes `backproject-peel` (Bavoil, Callahan and Silva 2006): several layers of one map, projected back onto the
/// light. docs/backproject-peel.md.
std::unique_ptr<visibility::Method> make_backproject_peel(const render::Device& device,
                                                          const visibility::MethodOptions& options);
visibility::MethodDescription backproject_peel_description();

/// Makes `layer-rays` (Keating and Max 1999): rays to the light samples through layers of one map. docs/layer-rays.md.
std::unique_ptr<visibility::Method> make_layer_rays(const render::Device& device,
                                                    const visibility::MethodOptions& options);
visibility::MethodDescription layer_rays_description();

}  // namespace penumbra::maps
