// SPDX-License-Identifier: Apache-2.0
// Chooses a device: the requested one; else discrete before integrated before virtual before processors, and among
// those of one kind the one that lacks fewer features.

#include "render/physical_device.hpp"

#include "render/optional_features.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <iterator>
#include <system_error>
#include <utility>

namespace penumbra::render {
namespace {

const char* kind_of(vk::PhysicalDeviceType type) {
  switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
      return "discrete";
    case vk::PhysicalDeviceType::eIntegratedGpu:
      return "integrated";
    case vk::PhysicalDeviceType::eVirtualGpu:
      return "virtual";
    case vk::PhysicalDeviceType::eCpu:
      return "cpu";
    default:
      return "other";
  }
}

std::string version_text(std::uint32_t version) {
  return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                     VK_API_VERSION_PATCH(version));
}

/// Returns the features that all of Penumbra needs and the device lacks: each with its name in Vulkan, and its purpose.
std::vector<std::string> missing_features(const vk::raii::PhysicalDevice& physical) {
  const auto chain = physical.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan11Features,
                                           vk::PhysicalDeviceVulkan12Features, vk::PhysicalDeviceVulkan13Features>();
  const auto& core = chain.get<vk::PhysicalDeviceFeatures2>().features;
  const auto& v12 = chain.get<vk::PhysicalDeviceVulkan12Features>();
  const auto& v13 = chain.get<vk::PhysicalDeviceVulkan13Features>();
  std::vector<std::string> missing;
  const auto need = [&](vk::Bool32 has, const char* what) {
    if (has == VK_FALSE) missing.emplace_back(what);
  };
  need(core.fragmentStoresAndAtomics, "no fragmentStoresAndAtomics (maps are written into storage buffers)");
  need(v12.scalarBlockLayout, "no scalarBlockLayout (structs are shared between C++ and GLSL)");
  need(v13.dynamicRendering, "no dynamicRendering");
  need(v13.synchronization2, "no synchronization2");
  need(v13.maintenance4, "no maintenance4");
  need(v13.subgroupSizeControl, "no subgroupSizeControl");
  return missing;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool is_wanted(const DeviceInfo& info, const std::string& wanted) {
  if (wanted.empty()) return true;
  if (std::all_of(wanted.begin(), wanted.end(), [](unsigned char c) { return std::isdigit(c) != 0; })) {
    return fmt::format("{}", info.index) == wanted;
  }
  if (wants_any_processor(wanted)) return info.kind == "cpu";
  return lower(info.name).find(lower(wanted)) != std::string::npos;
}

int preference(const DeviceInfo& info) {
  if (info.kind == "discrete") return 0;
  if (info.kind == "integrated") return 1;
  if (info.kind == "virtual") return 2;
  return info.kind == "cpu" ? 3 : 4;
}

/// Among devices of one kind, one that lacks fewer features comes first.
bool comes_before(const DeviceInfo& a, const DeviceInfo& b) {
  return std::pair(preference(a), a.lacks.size()) < std::pair(preference(b), b.lacks.size());
}

}  // namespace

std::vector<vk::raii::PhysicalDevice> physical_devices(const vk::raii::Instance& instance) {
  try {
    vk::raii::PhysicalDevices devices(instance);
    return {std::make_move_iterator(devices.begin()), std::make_move_iterator(devices.end())};
  } catch (const vk::SystemError&) {
    return {};  // a loader without a working driver
  }
}

std::optional<std::uint32_t> find_queue_family(const vk::raii::PhysicalDevice& physical) {
  const auto families = physical.getQueueFamilyProperties();
  const auto wanted = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    if ((families[i].queueFlags & wanted) == wanted) return i;
  }
  return std::nullopt;
}

DeviceInfo describe(const vk::raii::PhysicalDevice& physical, std::uint32_t index) {
  const auto properties = physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceSubgroupProperties,
                                                  vk::PhysicalDeviceDriverProperties>();
  const auto& core = properties.get<vk::PhysicalDeviceProperties2>().properties;
  const auto& subgroup = properties.get<vk::PhysicalDeviceSubgroupProperties>();
  const auto& driver = properties.get<vk::PhysicalDeviceDriverProperties>();
  DeviceInfo info;
  info.index = index;
  info.name = core.deviceName.data();
  info.kind = kind_of(core.deviceType);
  info.driver = fmt::format("{} {}", driver.driverName.data(), driver.driverInfo.data());
  info.api_version = version_text(core.apiVersion);
  info.max_storage_buffer_range = core.limits.maxStorageBufferRange;
  info.subgroup_size = subgroup.subgroupSize;
  const auto memory = physical.getMemoryProperties();
  for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
    if (memory.memoryHeaps[i].flags & vk::MemoryHeapFlagBits::eDeviceLocal) {
      info.memory_bytes = std::max<std::uint64_t>(info.memory_bytes, memory.memoryHeaps[i].size);
    }
  }
  if (core.apiVersion < VK_API_VERSION_1_3) {
    info.refusals.push_back(fmt::format("Vulkan {} is older than 1.3", info.api_version));
    return info;  // the feature structs below belong to Vulkan 1.3
  }
  info.refusals = missing_features(physical);
  info.lacks = lacking(physical);
  if (!find_queue_family(physical)) info.refusals.emplace_back("no queue with graphics and compute");
  return info;
}

bool has_gpu_nodes(const std::filesystem::path& folder) {
#ifdef __linux__
  // Device files of the kernel's DRM drivers (render nodes; a card without one only shows pictures), of NVIDIA's own
  // driver, of Windows drivers under WSL, and of Adreno and Mali on Android kernels.
  for (const char* name : {"nvidiactl", "dxg", "kgsl-3d0", "mali0"}) {
    if (std::error_code ignored; std::filesystem::exists(folder / name, ignored)) return true;
  }
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder / "dri", error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().filename().string().starts_with("renderD")) return true;
  }
  return false;
#else
  static_cast<void>(folder);
  return true;
#endif
}

bool names_drivers() {
  return std::ranges::any_of(std::array{"VK_DRIVER_FILES", "VK_ICD_FILENAMES", "VK_ADD_DRIVER_FILES"},
                             [](const char* name) { return std::getenv(name) != nullptr; });
}

ResourceError no_driver() {
  return ResourceError(
      "no Vulkan device: the loader found no driver; install one (mesa-vulkan-drivers runs on any processor) and check "
      "VK_DRIVER_FILES and VK_ICD_FILENAMES");
}

bool wants_any_processor(const std::string& wanted) {
  return lower(wanted) == "cpu";
}

bool has_usable(const std::vector<vk::raii::PhysicalDevice>& devices) {
  for (std::uint32_t i = 0; i < devices.size(); ++i) {
    if (describe(devices[i], i).usable()) return true;
  }
  return false;
}

DeviceInfo choose(const std::vector<vk::raii::PhysicalDevice>& devices, const std::string& wanted) {
  std::optional<DeviceInfo> best;
  std::string reasons;
  for (std::uint32_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo info = describe(devices[i], i);
    if (!is_wanted(info, wanted)) {
      reasons += fmt::format("\n  {} {}: not what --device {} asks for", i, info.name, wanted);
    } else if (!info.usable()) {
      reasons += fmt::format("\n  {} {}: {}", i, info.name, fmt::join(info.refusals, "; "));
    } else if (!best || comes_before(info, *best)) {
      best = info;
    }
  }
  if (best) return *best;
  if (devices.empty()) throw no_driver();
  throw ResourceError("no usable Vulkan device:{}", reasons);
}

Limits read_limits(const vk::raii::PhysicalDevice& physical, std::uint32_t timestamp_bits) {
  const auto& limits = physical.getProperties().limits;
  Limits out;
  out.max_storage_buffer_range = limits.maxStorageBufferRange;
  out.subgroup_size = physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceSubgroupProperties>()
                          .get<vk::PhysicalDeviceSubgroupProperties>()
                          .subgroupSize;
  out.max_shared_memory = limits.maxComputeSharedMemorySize;
  out.max_workgroup_count = limits.maxComputeWorkGroupCount[0];
  out.max_image_size = std::min(limits.maxImageDimension2D, limits.maxFramebufferWidth);
  out.max_texel_buffer_elements = limits.maxTexelBufferElements;
  out.subpixel_bits = limits.subPixelPrecisionBits;
  out.timestamp_period = timestamp_bits == 0 ? 0.0 : static_cast<double>(limits.timestampPeriod);
  return out;
}

}  // namespace penumbra::render
