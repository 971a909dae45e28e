#pragma once

#include "render/device.hpp"

#include <string>
#include <vector>

namespace penumbra::app {

/// A method, or a form of it, that does not run on a device.
struct RefusedMethod {
  std::string method;  ///< "hard-volume", "depth-complexity:variant=forest"
  std::string reason;  ///< begins with the method's name
};

/// Finds the methods that a usable device cannot run: makes each method there, as it is and with each
/// choice of each option. No device is made for one that lacks nothing.
std::vector<RefusedMethod> refused_methods(const render::DeviceInfo& device);

}  // namespace penumbra::app
