#include "render/device.hpp"

#include "base/error.hpp"
#include "base/memory.hpp"
#include "base/threads.hpp"
#include "render/vulkan.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
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

/// Why the loader makes no instance, in its own words: its error code alone is "out of host memory" for a driver's
/// description that is no JSON.
ResourceError no_instance(const vk::raii::Context& context, const vk::SystemError& error) {
  ValidationLog log;
  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  const vk::DebugUtilsMessengerCreateInfoEXT listener(
      {}, Severity::eError | Severity::eWarning, vk::DebugUtilsMessageTypeFlagBitsEXT::eGeneral, &on_message, &log);
  const vk::ApplicationInfo application("penumbra", 1, "penumbra", 1, VK_API_VERSION_1_3);
  const std::array extensions{VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
  try {
    const vk::raii::Instance again(context, vk::InstanceCreateInfo({}, &application, {}, extensions, &listener));
  } catch (const vk::SystemError&) {  // as before
  }
  return ResourceError(
      "no Vulkan: the loader makes no instance ({}); it says: {}; check VK_DRIVER_FILES and VK_ICD_FILENAMES, or "
      "whether memory is short",
      error.what(), log.messages.empty() ? "nothing more" : fmt::format("{}", fmt::join(log.messages, "; ")));
}

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

std::optional<std::uint32_t> find_queue_family(const vk::raii::PhysicalDevice& physical) {
  const auto families = physical.getQueueFamilyProperties();
  const auto wanted = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    if ((families[i].queueFlags & wanted) == wanted) return i;
  }
  return std::nullopt;
}

/// Each feature that Penumbra needs: how it is read from the device, and what it is for.
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
  need(core.shaderFloat64, "no shaderFloat64 (view samples are decided in double precision)");
  need(core.shaderInt64, "no shaderInt64 (the visibility buffer orders double distances as 64-bit integers)");
  need(v12.shaderBufferInt64Atomics,
       "no shaderBufferInt64Atomics (the visibility buffer takes the nearest by atomicMin)");
  need(core.fragmentStoresAndAtomics, "no fragmentStoresAndAtomics (the visibility buffer is a storage buffer)");
  need(v12.scalarBlockLayout, "no scalarBlockLayout (structs are shared between C++ and GLSL)");
  need(v13.dynamicRendering, "no dynamicRendering");
  need(v13.synchronization2, "no synchronization2");
  need(v13.maintenance4, "no maintenance4");
  need(v13.subgroupSizeControl, "no subgroupSizeControl");
  return missing;
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
    return info;  // the feature structs below are 1.3's
  }
  info.refusals = missing_features(physical);
  const auto wanted = vk::SubgroupFeatureFlagBits::eBasic | vk::SubgroupFeatureFlagBits::eBallot |
                      vk::SubgroupFeatureFlagBits::eShuffle | vk::SubgroupFeatureFlagBits::eArithmetic |
                      vk::SubgroupFeatureFlagBits::eVote;
  if ((subgroup.supportedOperations & wanted) != wanted) {
    info.refusals.emplace_back("no subgroup ballot, shuffle, vote or arithmetic operations");
  }
  if (info.subgroup_size < 8 || info.subgroup_size > 64) {
    info.refusals.push_back(fmt::format("subgroups of {} lanes (8 to 64 are supported)", info.subgroup_size));
  }
  if (!find_queue_family(physical)) info.refusals.emplace_back("no queue with graphics and compute");
  return info;
}

std::vector<vk::raii::PhysicalDevice> physical_devices(const vk::raii::Instance& instance) {
  try {
    vk::raii::PhysicalDevices devices(instance);
    return {std::make_move_iterator(devices.begin()), std::make_move_iterator(devices.end())};
  } catch (const vk::SystemError&) {
    return {};  // a loader without a driver that works
  }
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
  if (lower(wanted) == "cpu") return info.kind == "cpu";
  return lower(info.name).find(lower(wanted)) != std::string::npos;
}

int preference(const DeviceInfo& info) {
  if (info.kind == "discrete") return 0;
  if (info.kind == "integrated") return 1;
  if (info.kind == "virtual") return 2;
  return info.kind == "cpu" ? 3 : 4;
}

ResourceError no_driver() {
  return ResourceError(
      "no Vulkan device: the loader found no driver; install one (mesa-vulkan-drivers runs on any processor) and check "
      "VK_DRIVER_FILES and VK_ICD_FILENAMES");
}

/// The best usable wanted device, or a ResourceError that says of each device why not.
DeviceInfo choose(const std::vector<vk::raii::PhysicalDevice>& devices, const std::string& wanted) {
  std::optional<DeviceInfo> best;
  std::string reasons;
  for (std::uint32_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo info = describe(devices[i], i);
    if (!is_wanted(info, wanted)) {
      reasons += fmt::format("\n  {} {}: not what --device {} asks for", i, info.name, wanted);
    } else if (!info.usable()) {
      reasons += fmt::format("\n  {} {}: {}", i, info.name, fmt::join(info.refusals, "; "));
    } else if (!best || preference(info) < preference(*best)) {
      best = info;
    }
  }
  if (best) return *best;
  if (devices.empty()) throw no_driver();
  throw ResourceError("no usable Vulkan device:{}", reasons);
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

/// A cache that cannot be written is no error: the next start is a little slower.
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
  core.shaderFloat64 = core.shaderInt64 = core.fragmentStoresAndAtomics = VK_TRUE;
  auto& v12 = chain.get<vk::PhysicalDeviceVulkan12Features>();
  v12.shaderBufferInt64Atomics = v12.scalarBlockLayout = VK_TRUE;
  auto& v13 = chain.get<vk::PhysicalDeviceVulkan13Features>();
  v13.dynamicRendering = v13.synchronization2 = v13.maintenance4 = v13.subgroupSizeControl = VK_TRUE;
  const auto available = physical.enumerateDeviceExtensionProperties();
  std::vector<const char*> extensions;
  if (has_extension(available, "VK_KHR_portability_subset")) extensions.push_back("VK_KHR_portability_subset");
  chain.get<vk::DeviceCreateInfo>().setPEnabledExtensionNames(extensions);
  return vk::raii::Device(physical, chain.get<vk::DeviceCreateInfo>());
}

/// What Mesa's driver for processors starts: a team that rasterises, a team that computes, one thread that takes work,
/// one for its cache. It says nothing if it cannot, and then never does the work.
unsigned driver_threads() {
  constexpr unsigned kLargestTeam = 16;
  return 2 * std::clamp(std::thread::hardware_concurrency(), 1U, kLargestTeam) + 2;
}

/// What that driver takes for its compiler and its threads' stacks before the first pass runs, with some to spare. It
/// does not look whether it got them.
constexpr std::uint64_t kDriverBytes = std::uint64_t{256} << 20;

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
  out.timestamp_period = timestamp_bits == 0 ? 0.0 : static_cast<double>(limits.timestampPeriod);
  return out;
}

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

Device::Device(const DeviceOptions& options) try : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.log = std::make_unique<ValidationLog>();
  try {
    s.instance = make_instance(s.context, options.validation, s.debug_names);
  } catch (const vk::IncompatibleDriverError&) {
    throw no_driver();
  } catch (const vk::SystemError& error) {
    throw no_instance(s.context, error);
  }
  if (options.validation) {
    using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
    using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
    s.messenger = vk::raii::DebugUtilsMessengerEXT(
        s.instance,
        vk::DebugUtilsMessengerCreateInfoEXT({}, Severity::eWarning | Severity::eError,
                                             Type::eValidation | Type::ePerformance, &on_message, s.log.get()));
  }
  auto devices = physical_devices(s.instance);
  s.info = choose(devices, options.wanted);
  s.physical = std::move(devices[s.info.index]);
  s.queue_family = find_queue_family(s.physical).value();
  s.timestamp_bits = s.physical.getQueueFamilyProperties()[s.queue_family].timestampValidBits;
  s.limits = read_limits(s.physical, s.timestamp_bits);
  s.memory = s.physical.getMemoryProperties();
  longest_wait(s.info.kind == "cpu");  // wrong values are refused here, while nothing is at work
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
} catch (const vk::IncompatibleDriverError&) {
  throw no_driver();
} catch (const vk::SystemError& error) {
  fail(error, "making the Vulkan device");
} catch (const std::runtime_error& error) {
  if (dynamic_cast<const Error*>(&error) != nullptr) throw;
  throw ResourceError("no Vulkan: {}", error.what());  // the loader's library is not there
}

Device::~Device() {
  if (!state_) return;
  if (state_->abandoned) {
    static_cast<void>(state_.release());  // destroying it would wait for ever
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

std::vector<std::string> Device::take_validation_messages() const {
  const std::lock_guard lock(state_->log->mutex);
  return std::exchange(state_->log->messages, {});
}

}  // namespace penumbra::render
