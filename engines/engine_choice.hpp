#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"

#include <string>

namespace penumbra::engines {

/// engine=auto|vulkan|native of a method that has both; auto: native where the device is a processor. Throws
/// UsageError.
bool runs_natively(const render::Device& device, const visibility::MethodOptions& options, const std::string& method);

}  // namespace penumbra::engines
