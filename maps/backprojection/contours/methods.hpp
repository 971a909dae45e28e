#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

/// Factory and description of each method; a description needs no device.
namespace penumbra::maps {

/// Guennebaud, Barthe and Paulin 2007: contours of what shades, on one map. docs/contour.md.
std::unique_ptr<visibility::Method> make_contour(const render::Device& device,
                                                 const visibility::MethodOptions& options);
visibility::MethodDescription contour_description();

/// Yang, Feng, Guennebaud and Liu 2009: contours for packets of pixels, found in a hierarchy. docs/packet.md.
std::unique_ptr<visibility::Method> make_packet(const render::Device& device, const visibility::MethodOptions& options);

/// What these options make of it; needs no device. A light with a texture takes `sublights` of 2 or more. UsageError
/// for a `packet` that is not WxH or has more pixels than a workgroup keeps.
visibility::MethodDescription packet_description(const visibility::MethodOptions& options = {});

}  // namespace penumbra::maps
