#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::maps {

/// Reeves, Salesin, Cook 1987: the share of a fixed window of texels that do not shade the receiver, in one map from
/// the light's centre. docs/pcf.md.
std::unique_ptr<visibility::Method> make_pcf(const render::Device& device, const visibility::MethodOptions& options);

/// What it is; needs no device.
visibility::MethodDescription pcf_description();

}  // namespace penumbra::maps
