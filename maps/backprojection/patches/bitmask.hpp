#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// Schwarz and Stamminger 2007: what texels of one map hide, as bits of the light samples. docs/bitmask.md.
std::unique_ptr<visibility::Method> make_bitmask(const render::Device& device,
                                                 const visibility::MethodOptions& options);

/// What it is with these options, none by default; needs no device. Of few pixels (subsample) it gives V alone.
visibility::MethodDescription bitmask_description(const visibility::MethodOptions& options = {});

}  // namespace penumbra::maps
