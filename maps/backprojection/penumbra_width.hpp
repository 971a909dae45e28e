#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// Answers as a method does, but with, for each view sample, how wide the narrowest penumbra there may be, in scene
/// units parallel to the light: by the farthest from the light of what its map has in the kernel (penumbra_width.comp).
/// Infinity: nothing there hides light. `options`: of a method with a map from the light's centre; others are passed
/// over.
std::unique_ptr<visibility::Method> make_penumbra_widths(const render::Device& device,
                                                         const visibility::MethodOptions& options);

}  // namespace penumbra::maps
