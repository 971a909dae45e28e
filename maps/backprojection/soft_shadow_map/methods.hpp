// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

/// Factory and description of each method. Descriptions are callable without a Vulkan device.
namespace penumbra::maps {

/// Makes `soft-shadow-map` (Atty et al. 2006): a map of soft shadows from a map of occluders and a map of receivers.
/// docs/soft-shadow-map.md.
std::unique_ptr<visibility::Method> make_soft_shadow_map(const render::Device& device,
                                                         const visibility::MethodOptions& options);
visibility::MethodDescription soft_shadow_map_description();

}  // namespace penumbra::maps
