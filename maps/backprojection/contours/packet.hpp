#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// Yang, Feng, Guennebaud and Liu 2009: contours for packets of pixels, found in a hierarchy. docs/packet.md.
std::unique_ptr<visibility::Method> make_packet(const render::Device& device, const visibility::MethodOptions& options);

/// What these options make of it; needs no device. A light with a texture takes `sublights` of 2 or more. UsageError
/// for a `packet` that is not WxH or has more pixels than a workgroup keeps.
visibility::MethodDescription packet_description(const visibility::MethodOptions& options = {});

}  // namespace penumbra::maps
