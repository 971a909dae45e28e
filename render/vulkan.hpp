// SPDX-License-Identifier: Apache-2.0
#pragma once
// Inside render/ only: the one header that includes all of vulkan_raii.hpp.

#include "render/buffer.hpp"
#include "render/commands.hpp"
#include "render/device.hpp"

#include <vulkan/vulkan_raii.hpp>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace penumbra::render {

/// Collects the validation layer's messages; the callback may come from any thread.
struct ValidationLog {
  std::mutex mutex;
  std::vector<std::string> messages;
};

/// The pipelines that a device has made and caches (pipelines.hpp).
class Pipelines;

struct Device::State {
  std::unique_ptr<ValidationLog> log;
  vk::raii::Context context;
  vk::raii::Instance instance{nullptr};
  vk::raii::DebugUtilsMessengerEXT messenger{nullptr};
  vk::raii::PhysicalDevice physical{nullptr};
  vk::raii::Device device{nullptr};
  std::uint32_t queue_family = 0;
  vk::raii::Queue queue{nullptr};
  vk::raii::CommandPool pool{nullptr};
  vk::raii::PipelineCache cache{nullptr};
  std::filesystem::path cache_file;  // empty: there is no folder for it
  std::vector<char> cache_on_disk;   // content of cache_file when the device was made
  vk::PhysicalDeviceMemoryProperties memory;
  std::uint32_t timestamp_bits = 0;
  DeviceInfo info;
  Limits limits;
  std::uint64_t allocated = 0, peak = 0;
  bool debug_names = false;
  bool only_checks = false;  // as in DeviceOptions
  bool abandoned = false;    // see abandon()
  std::unique_ptr<opengl::Context> opengl;
  std::unique_ptr<Pipelines, void (*)(Pipelines*)> pipelines{nullptr, nullptr};

  void account(std::int64_t bytes) {
    allocated = static_cast<std::uint64_t>(static_cast<std::int64_t>(allocated) + bytes);
    peak = std::max(peak, allocated);
  }
  template <typename Handle>
  void name(const Handle& handle, const std::string& text) const;
};

/// Returns the time limit of one submission: PENUMBRA_DEVICE_TIMEOUT in seconds, else a day on processors, an hour
/// elsewhere. Throws UsageError for a value that is not a number of seconds.
std::chrono::seconds longest_wait(bool is_processor);

/// Waits until the device has finished the work submitted with the fence; `what` names the work in messages. Throws
/// DeviceDoesNotAnswer when the work is known to never finish, or exceeds the limit (PENUMBRA_DEVICE_TIMEOUT).
void wait_for(Device::State& device, const vk::raii::Fence& fence, const std::string& what);

/// Disables the destruction of all objects of the device, in whichever destructor: they may still be in use, and
/// destroying a device waits for its work.
void abandon(Device::State& device);

/// Dedicated memory of one buffer or image: there are only tens of resources.
struct Allocation {
  vk::raii::DeviceMemory memory{nullptr};
  bool host_visible = false;
  std::uint64_t bytes = 0;
};
Allocation allocate(Device::State& device, const vk::MemoryRequirements& needs, bool prefer_host,
                    const std::string& name);

struct Buffer::State {
  Device::State* device = nullptr;
  std::string name;
  std::uint64_t bytes = 0;
  vk::raii::Buffer buffer{nullptr};
  Allocation allocation;
  void* mapped = nullptr;              // set if host-visible
  vk::raii::BufferView view{nullptr};  // set for texel buffers
  ~State();
};

struct Commands::State {
  Device::State* device = nullptr;
  vk::raii::CommandBuffer commands{nullptr};
  vk::raii::Fence fence{nullptr};
  vk::raii::QueryPool queries{nullptr};
  std::vector<std::string> pass_names;
  // Descriptor pools live as long as the recording that uses their sets.
  std::vector<vk::raii::DescriptorPool> pools;
  bool recording = false;
  bool host_timed = false;
  std::vector<visibility::PassTime> host_times;
  std::vector<visibility::PassTime> earlier;  // times of passes that host_pass had to run; submit returns them first
  std::chrono::steady_clock::time_point opened;

  void begin_if_needed();
  /// Submits the recorded commands and waits for them.
  void run();
  /// Opens a named region: a debug label and a timestamp before it; close_pass writes the second timestamp and a full
  /// barrier.
  void open_pass(const std::string& name);
  void close_pass();
};

/// Interface of one shader stage, by reflection.
struct ShaderInterface {
  std::vector<vk::DescriptorType> bindings;  // bindings of set 0, by index
  std::uint32_t push_bytes = 0;
};
ShaderInterface reflect(std::span<const std::uint32_t> spirv, const std::string& name);

/// Throws ResourceError for a Vulkan failure; `doing` describes the failed operation.
[[noreturn]] void fail(const vk::SystemError& error, const std::string& doing);

template <typename Handle>
void Device::State::name(const Handle& handle, const std::string& text) const {
  if (!debug_names) return;
  using C = std::remove_cvref_t<decltype(*handle)>;
  device.setDebugUtilsObjectNameEXT(vk::DebugUtilsObjectNameInfoEXT(
      C::objectType, reinterpret_cast<std::uint64_t>(static_cast<typename C::CType>(*handle)), text.c_str()));
}

}  // namespace penumbra::render
