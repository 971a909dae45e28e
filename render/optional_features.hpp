// SPDX-License-Identifier: Apache-2.0
#pragma once
// Inside render/ only.

#include "render/vulkan.hpp"

#include <string>
#include <vector>

namespace penumbra::render {

/// Features that some shaders use and that not every device has. All available ones in `core` are enabled.
struct OptionalFeatures {
  vk::PhysicalDeviceFeatures core;
  vk::PhysicalDeviceVulkan12Features v12;
};
OptionalFeatures optional_features(const vk::raii::PhysicalDevice& physical);

/// Returns the names of the features that a Vulkan 1.3 device lacks, subgroup operations included.
std::vector<std::string> lacking(const vk::raii::PhysicalDevice& physical);

}  // namespace penumbra::render
