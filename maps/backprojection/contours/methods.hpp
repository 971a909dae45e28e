// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

/// Factory and description of each method. Descriptions are callable without a Vulkan device.
namespace penumbra::maps {

/// Makes `contour` (Guennebaud, Barthe and Paulin 2007): contours of the texels that shade, on one map.
/// docs/contour.md.
std::unique_ptr<visibility::Method> make_contour(const render::Device& device,
                                                 const visibility::MethodOptions& options);
visibility::MethodDescription contour_description();

/// Makes `packet` (Yang, Feng, Guennebaud and Liu 2009): contours for packets of pixels, found in a hierarchy.
/// docs/packet.md.
std::unique_ptr<visibility::Method> make_packet(const render::Device& device, const visibility::MethodOptions& options);

/// Returns the description with `options`. Callable without a Vulkan device. A light with a texture requires
/// `sublights` of 2 or more. Throws UsageError if `packet` is not WxH or has more pixels than a workgroup holds.
visibility::MethodDescription packet_description(const visibility::MethodOptions& options = {});

}  // namespace penumbra::maps
