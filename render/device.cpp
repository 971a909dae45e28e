// SPDX-License-Identifier: Apache-2.0
// Makes a Vulkan 1.3 instance and device: chooses among physical devices, enables the features that exist, collects
// messages of the validation layer, and reports the loader's own reason if the loader makes no instance.

#include "render/device.hpp"

#include "base/error.hpp"
#include "base/memory.hpp"
#include "base/threads.hpp"
#include "render/optional_features.hpp"
#include "render/physical_device.hpp"
#include "render/vulkan.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

namespace penumbra::render {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  auto* log = static_cast<ValidationLog*>(user);
  const std::lock_guard lock(log->mutex);
  log->messages.emplace_back(data->pMessage);
  return VK_FALSE;
}

bool has_layer(const vk::raii::Context& context, std::string_view name) {
  const auto layers = context.enumerateInstanceLayerProperties();
  return std::any_of(layers.begin(), layers.end(), [&](const auto& layer) { return name == layer.layerName.data(); });
}

bool has_extension(const std::vector<vk::ExtensionProperties>& extensions, std::string_view name) {
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const auto& extension) { return name == extension.extensionName.data(); });
}

vk::raii::Instance make_instance(const vk::raii::Context& context, bool validation, bool& debug_names) {
  const vk::ApplicationInfo application("penumbra", 1, "penumbra", 1, VK_API_VERSION_1_3);
  std::vector<const char*> layers, extensions;
  if (validation) {
    if (!has_layer(context, kValidationLayer)) {
      throw ResourceError("validation was asked for, but the layer {} is not installed (vulkan-validationlayers)",
                          kValidationLayer);
    }
    layers.push_back(kValidationLayer);
  }
  const auto available = context.enumerateInstanceExtensionProperties();
  debug_names = validation;
  if (validation) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  vk::InstanceCreateFlags flags;
  if (has_extension(available, VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME)) {
    extensions.push_back(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
    flags |= vk::InstanceCreateFlagBits::eEnumeratePortabilityKHR;
  }
  const std::array enabled{vk::ValidationFeatureEnableEXT::eSynchronizationValidation};
  const vk::ValidationFeaturesEXT features(enabled, {});
  const vk::InstanceCreateInfo info(flags, &application, layers, extensions, validation ? &features : nullptr);
  return vk::raii::Instance(context, info);
}

/// Returns the reason why the loader makes no instance, from its own messages: its error code alone is "out of host
/// memory" for a driver's description that is not JSON.
ResourceError no_instance(const vk::raii::Context& context, const vk::SystemError& error) {
  ValidationLog log;
  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  const vk::DebugUtilsMessengerCreateInfoEXT listener(
      {}, Severity::eError | Severity::eWarning, vk::DebugUtilsMessageTypeFlagBitsEXT::eGeneral, &on_message, &log);
  const vk::ApplicationInfo application("penumbra", 1, "penumbra", 1, VK_API_VERSION_1_3);
  const std::array extensions{VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
  try {
    const vk::raii::Instance again(context, vk::InstanceCreateInfo({}, &application, {}, extensions, &listener));
  } catch (const vk::SystemError&) {  // the validation log has the reason
  }
  return ResourceError(
      "no Vulkan: the loader makes no instance ({}); it says: {}; check VK_DRIVER_FILES and VK_ICD_FILENAMES, or "
      "whether memory is short",
      error.what(), log.messages.empty() ? "nothing more" : fmt::format("{}", fmt::join(log.messages, "; ")));
}

std::filesystem::path cache_path(const vk::PhysicalDeviceProperties& properties) {
  std::filesystem::path folder;
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg != nullptr && *xdg != '\0') {
    folder = xdg;
  } else if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
    folder = std::filesystem::path(home) / ".cache";
  } else {
    return {};
  }
  return folder / "penumbra" /
         fmt::format("pipelines-{:04x}-{:04x}-{:08x}.bin", properties.vendorID, properties.deviceID,
                     properties.driverVersion);
}

std::vector<char> read_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Failing to write the cache is not an error: the next start is slightly slower.
void save_cache(const Device::State& state) try {
  if (state.cache_file.empty()) return;
  const auto data = state.cache.getData();
  if (std::equal(data.begin(), data.end(), state.cache_on_disk.begin(), state.cache_on_disk.end(),
                 [](auto a, auto b) { return static_cast<unsigned char>(a) == static_cast<unsigned char>(b); })) {
    return;
  }
  std::filesystem::create_directories(state.cache_file.parent_path());
  const std::filesystem::path temporary = state.cache_file.string() + fmt::format(".{}", getpid());
  std::ofstream stream(temporary, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(data.data()), static_cast<std::streamsize>(data.size()));
  stream.close();
  if (stream) {
    std::filesystem::rename(temporary, state.cache_file);
  } else {
    std::filesystem::remove(temporary);
  }
} catch (const std::exception&) {
}

vk::raii::Device make_device(const vk::raii::PhysicalDevice& physical, std::uint32_t family) {
  const float priority = 1.0F;
  const vk::DeviceQueueCreateInfo queue({}, family, 1, &priority);
  vk::StructureChain<vk::DeviceCreateInfo, vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                     vk::PhysicalDeviceVulkan13Features>
      chain;
  chain.get<vk::DeviceCreateInfo>().setQueueCreateInfos(queue);
  auto& core = chain.get<vk::PhysicalDeviceFeatures2>().features;
  auto& v12 = chain.get<vk::PhysicalDeviceVulkan12Features>();
  OptionalFeatures there = optional_features(physical);
  core = there.core;
  core.fragmentStoresAndAtomics = VK_TRUE;
  there.v12.pNext = v12.pNext;
  v12 = there.v12;
  v12.scalarBlockLayout = VK_TRUE;
  auto& v13 = chain.get<vk::PhysicalDeviceVulkan13Features>();
  v13.dynamicRendering = v13.synchronization2 = v13.maintenance4 = v13.subgroupSizeControl = VK_TRUE;
  const auto available = physical.enumerateDeviceExtensionProperties();
  std::vector<const char*> extensions;
  if (has_extension(available, "VK_KHR_portability_subset")) extensions.push_back("VK_KHR_portability_subset");
  chain.get<vk::DeviceCreateInfo>().setPEnabledExtensionNames(extensions);
  return vk::raii::Device(physical, chain.get<vk::DeviceCreateInfo>());
}

/// Returns the number of threads that Mesa's driver for processors starts: a team that rasterises, a team that
/// computes, one thread that accepts work, one for its cache. If it cannot start them, it reports nothing, and never
/// does the work.
unsigned driver_threads() {
  constexpr unsigned kLargestTeam = 16;
  return 2 * std::clamp(std::thread::hardware_concurrency(), 1U, kLargestTeam) + 2;
}

/// Memory that Mesa's driver for processors takes for its compiler and its threads' stacks before the first pass runs,
/// with a reserve. The driver does not check that it got the memory.
constexpr std::uint64_t kDriverBytes = std::uint64_t{256} << 20;

}  // namespace

void fail(const vk::SystemError& error, const std::string& doing) {
  const auto code = static_cast<vk::Result>(error.code().value());
  if (code == vk::Result::eErrorOutOfDeviceMemory || code == vk::Result::eErrorOutOfHostMemory) {
    throw ResourceError("{}: out of memory; try a smaller --size or fewer --light-samples", doing);
  }
  if (code == vk::Result::eErrorDeviceLost) throw ResourceError("{}: the Vulkan device was lost", doing);
  throw ResourceError("{}: {}", doing, error.what());
}

std::vector<DeviceInfo> list_devices() try {
  const vk::raii::Context context;
  bool debug_names = false;
  const auto instance = make_instance(context, false, debug_names);
  const auto devices = physical_devices(instance);
  std::vector<DeviceInfo> list;
  for (std::uint32_t i = 0; i < devices.size(); ++i) list.push_back(describe(devices[i], i));
  return list;
} catch (const std::exception&) {
  return {};  // no loader, or none that can make an instance
}

namespace {

struct Opened {
  std::unique_ptr<Device::State> state;  ///< has an instance, but no device
  std::vector<vk::raii::PhysicalDevice> devices;
};

Opened open_instance(bool validation) {
  Opened opened{std::make_unique<Device::State>(), {}};
  Device::State& s = *opened.state;
  s.log = std::make_unique<ValidationLog>();
  try {
    s.instance = make_instance(s.context, validation, s.debug_names);
  } catch (const vk::IncompatibleDriverError&) {
    throw no_driver();
  } catch (const vk::SystemError& error) {
    throw no_instance(s.context, error);
  }
  if (validation) {
    using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
    using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
    s.messenger = vk::raii::DebugUtilsMessengerEXT(
        s.instance,
        vk::DebugUtilsMessengerCreateInfoEXT({}, Severity::eWarning | Severity::eError,
                                             Type::eValidation | Type::ePerformance, &on_message, s.log.get()));
  }
  opened.devices = physical_devices(s.instance);
  return opened;
}

std::unique_ptr<Device::State> open_device(Opened opened, DeviceInfo info) {
  Device::State& s = *opened.state;
  s.info = std::move(info);
  s.physical = std::move(opened.devices[s.info.index]);
  s.queue_family = find_queue_family(s.physical).value();
  s.timestamp_bits = s.physical.getQueueFamilyProperties()[s.queue_family].timestampValidBits;
  s.limits = read_limits(s.physical, s.timestamp_bits);
  s.memory = s.physical.getMemoryProperties();
  longest_wait(s.info.kind == "cpu");  // refuses invalid values here, before any work
  if (s.info.kind == "cpu") {
    require_threads(driver_threads(), "the device " + s.info.name);
    require_memory(kDriverBytes, "the device " + s.info.name, "raise the limit on memory (ulimit -v)");
  }
  s.device = make_device(s.physical, s.queue_family);
  s.queue = vk::raii::Queue(s.device, s.queue_family, 0);
  s.pool = vk::raii::CommandPool(
      s.device, vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eResetCommandBuffer, s.queue_family));
  s.cache_file = cache_path(s.physical.getProperties());
  if (!s.cache_file.empty()) s.cache_on_disk = read_file(s.cache_file);
  s.cache = vk::raii::PipelineCache(s.device,
                                    vk::PipelineCacheCreateInfo({}, s.cache_on_disk.size(), s.cache_on_disk.data()));
  return std::move(opened.state);
}

/// Returns the result of `open`; converts exceptions of Vulkan to ResourceError.
template <typename Open>
auto opening(Open open) {
  try {
    return open();
  } catch (const vk::IncompatibleDriverError&) {
    throw no_driver();
  } catch (const vk::SystemError& error) {
    fail(error, "making the Vulkan device");
  } catch (const std::runtime_error& error) {
    if (dynamic_cast<const Error*>(&error) != nullptr) throw;
    throw ResourceError("no Vulkan: {}", error.what());  // the loader's library does not exist
  }
}

}  // namespace

Device::Device(std::unique_ptr<State> state) : state_(std::move(state)) {}

Device::Device(const DeviceOptions& options)
    : Device(opening([&] {
        Opened opened = open_instance(options.validation);
        DeviceInfo info = choose(opened.devices, options.wanted);
        opened.state->only_checks = options.only_checks;
        return open_device(std::move(opened), std::move(info));
      })) {}

std::optional<Device> Device::find_gpu(const DeviceOptions& options) {
  if (wants_any_processor(options.wanted)) return std::nullopt;
  // The Vulkan loader opens every installed driver, which takes longer than a small picture.
  if (options.wanted.empty() && !names_drivers() && !has_gpu_nodes("/dev")) return std::nullopt;
  return opening([&]() -> std::optional<Device> {
    Opened opened;
    try {
      opened = open_instance(false);
    } catch (const std::runtime_error&) {  // no loader, or no driver
      if (!options.wanted.empty()) throw;
      return std::nullopt;
    }
    if (options.wanted.empty() && !has_usable(opened.devices)) return std::nullopt;
    DeviceInfo info = choose(opened.devices, options.wanted);
    if (info.kind == "cpu") return std::nullopt;
    if (options.validation) return Device(options);  // uses an instance with the layer
    return Device(open_device(std::move(opened), std::move(info)));
  });
}

Device::~Device() {
  if (!state_) return;
  if (state_->abandoned) {
    static_cast<void>(state_.release());  // leaked: destroying it would wait forever
    return;
  }
  save_cache(*state_);
}
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;

const DeviceInfo& Device::info() const {
  return state_->info;
}
const Limits& Device::limits() const {
  return state_->limits;
}
std::uint64_t Device::allocated_bytes() const {
  return state_->allocated;
}
std::uint64_t Device::peak_bytes() const {
  return state_->peak;
}
void Device::forget_peak() const {
  state_->peak = state_->allocated;
}

const opengl::Context& Device::opengl() const {
  if (!state_->opengl) state_->opengl = std::make_unique<opengl::Context>(state_->info.kind == "cpu");
  return *state_->opengl;
}

std::vector<std::string> Device::take_validation_messages() const {
  const std::lock_guard lock(state_->log->mutex);
  return std::exchange(state_->log->messages, {});
}

}  // namespace penumbra::render
