#pragma once

#include "render/device.hpp"
#include "render/vulkan.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Which of the machine's Vulkan devices can run Penumbra, and which of those it should be. Internal to this room.
namespace penumbra::render {

/// All that the loader knows; empty for a loader without a driver that works.
std::vector<vk::raii::PhysicalDevice> physical_devices(const vk::raii::Instance& instance);

/// What the device is, with every reason why it cannot run Penumbra.
DeviceInfo describe(const vk::raii::PhysicalDevice& physical, std::uint32_t index);

/// The best usable wanted device (DeviceOptions::wanted); throws a ResourceError that says of each device why not.
DeviceInfo choose(const std::vector<vk::raii::PhysicalDevice>& devices, const std::string& wanted);

/// Whether one of them can run Penumbra.
bool has_usable(const std::vector<vk::raii::PhysicalDevice>& devices);

/// Whether DeviceOptions::wanted is the word for any processor, `cpu`.
bool wants_any_processor(const std::string& wanted);

/// The first queue family with graphics and compute.
std::optional<std::uint32_t> find_queue_family(const vk::raii::PhysicalDevice& physical);

/// `timestamp_bits`: of the queue family.
Limits read_limits(const vk::raii::PhysicalDevice& physical, std::uint32_t timestamp_bits);

/// The loader is there, but no driver.
ResourceError no_driver();

}  // namespace penumbra::render
