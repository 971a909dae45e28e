#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// Yang, Feng, Guennebaud and Liu 2009: contours for packets of pixels, found in a hierarchy. docs/packet.md.
std::unique_ptr<visibility::Method> make_packet(const render::Device& device, const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription packet_description();

}  // namespace penumbra::maps
