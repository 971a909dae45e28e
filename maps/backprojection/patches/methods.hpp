#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

/// Factory and description of each method; a description needs no device.
namespace penumbra::maps {

/// Schwarz and Stamminger 2007: what texels of one map hide, as bits of the light samples. docs/bitmask.md.
std::unique_ptr<visibility::Method> make_bitmask(const render::Device& device,
                                                 const visibility::MethodOptions& options);

/// What it is with these options, none by default; needs no device. Of few pixels (subsample) it gives V alone.
visibility::MethodDescription bitmask_description(const visibility::MethodOptions& options = {});

/// Guennebaud, Barthe and Paulin 2006: texels of one map, projected back onto the light. docs/backproject.md.
std::unique_ptr<visibility::Method> make_backproject(const render::Device& device,
                                                     const visibility::MethodOptions& options);

/// What these options make of it; needs no device. Spheres (form=sphere) do sphere lights, too, and no textures.
visibility::MethodDescription backproject_description(const visibility::MethodOptions& options = {});

/// Bavoil, Callahan and Silva 2006: several layers of one map, projected back onto the light. docs/backproject-peel.md.
std::unique_ptr<visibility::Method> make_backproject_peel(const render::Device& device,
                                                          const visibility::MethodOptions& options);
visibility::MethodDescription backproject_peel_description();

/// Keating and Max 1999: rays to the light samples through layers of one map. docs/layer-rays.md.
std::unique_ptr<visibility::Method> make_layer_rays(const render::Device& device,
                                                    const visibility::MethodOptions& options);
visibility::MethodDescription layer_rays_description();

}  // namespace penumbra::maps
