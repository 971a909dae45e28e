// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "render/vulkan.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Selection of the Vulkan device that runs Penumbra. Internal to this room.
namespace penumbra::render {

/// Returns all devices that the loader lists; empty for a loader without a working driver.
std::vector<vk::raii::PhysicalDevice> physical_devices(const vk::raii::Instance& instance);

/// Describes the device, with every reason why it cannot run Penumbra.
DeviceInfo describe(const vk::raii::PhysicalDevice& physical, std::uint32_t index);

/// Returns the best usable wanted device (DeviceOptions::wanted); throws a ResourceError with the reason why each
/// device was refused.
DeviceInfo choose(const std::vector<vk::raii::PhysicalDevice>& devices, const std::string& wanted);

/// Returns whether one of the devices can run Penumbra.
bool has_usable(const std::vector<vk::raii::PhysicalDevice>& devices);

/// Returns whether DeviceOptions::wanted is `cpu`, which stands for any processor.
bool wants_any_processor(const std::string& wanted);

/// Returns the first queue family with graphics and compute.
std::optional<std::uint32_t> find_queue_family(const vk::raii::PhysicalDevice& physical);

/// `timestamp_bits`: property of the queue family.
Limits read_limits(const vk::raii::PhysicalDevice& physical, std::uint32_t timestamp_bits);

/// Returns whether a folder of device files has one through which a GPU's driver works. Always true on systems whose
/// names of such files are not known.
bool has_gpu_nodes(const std::filesystem::path& folder);

/// Returns whether the environment names the drivers that the loader opens: then these are used, GPU or not.
bool names_drivers();

/// Returns the error for a loader without a driver.
ResourceError no_driver();

}  // namespace penumbra::render
