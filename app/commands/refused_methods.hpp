// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"

#include <string>
#include <vector>

namespace penumbra::app {

/// Method, or form of a method, that does not run on a device.
struct RefusedMethod {
  std::string method;  ///< "hard-volume", "depth-complexity:variant=forest"
  std::string reason;  ///< beginning with the method's name
};

/// Returns the methods that a usable device cannot run: makes each method there, with its defaults and with each choice
/// of each option. Does not open a device that lacks nothing.
std::vector<RefusedMethod> refused_methods(const render::DeviceInfo& device);

}  // namespace penumbra::app
