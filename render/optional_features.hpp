#pragma once
// Inside render/ only.

#include "render/vulkan.hpp"

#include <string>
#include <vector>

namespace penumbra::render {

/// Features that some shaders use and not every device has. Of the first, all that there are get switched on.
struct OptionalFeatures {
  vk::PhysicalDeviceFeatures core;
  vk::PhysicalDeviceVulkan12Features v12;
};
OptionalFeatures optional_features(const vk::raii::PhysicalDevice& physical);

/// Of a Vulkan 1.3 device: the names of those that it lacks, operations of subgroups among them.
std::vector<std::string> lacking(const vk::raii::PhysicalDevice& physical);

}  // namespace penumbra::render
