// SPDX-License-Identifier: Apache-2.0
// Buffers of a device, one allocation each, and copies to and from the host through a staging buffer where memory is
// not host-visible. Each copy waits for its end, with a barrier that makes it visible to the host.

#include "render/buffer.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "render/vulkan.hpp"

#include <cstring>

namespace penumbra::render {
namespace {

std::optional<std::uint32_t> find_type(const Device::State& device, std::uint32_t allowed,
                                       vk::MemoryPropertyFlags wanted) {
  for (std::uint32_t i = 0; i < device.memory.memoryTypeCount; ++i) {
    if ((allowed >> i & 1U) != 0 && (device.memory.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  }
  return std::nullopt;
}

std::string human(std::uint64_t bytes) {
  return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1 << 20));
}

vk::raii::Buffer make_vk_buffer(const Device::State& device, std::uint64_t bytes, vk::BufferUsageFlags usage) {
  return {device.device, vk::BufferCreateInfo({}, bytes, usage, vk::SharingMode::eExclusive)};
}

/// Runs one copy in a separate command buffer, and waits for its end.
void copy_and_wait(Device::State& device, vk::Buffer from, vk::Buffer to, const vk::BufferCopy& region) {
  const vk::CommandBufferAllocateInfo info(*device.pool, vk::CommandBufferLevel::ePrimary, 1);
  const vk::raii::CommandBuffer commands = std::move(vk::raii::CommandBuffers(device.device, info).front());
  commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
  commands.copyBuffer(from, to, region);
  // A fence alone makes nothing visible to the host, nor to later passes.
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  const vk::MemoryBarrier2 barrier(Stage::eCopy, Access::eTransferWrite, Stage::eAllCommands | Stage::eHost,
                                   Access::eMemoryRead | Access::eMemoryWrite | Access::eHostRead);
  commands.pipelineBarrier2(vk::DependencyInfo({}, barrier));
  commands.end();
  const vk::raii::Fence fence(device.device, vk::FenceCreateInfo());
  device.queue.submit(vk::SubmitInfo({}, {}, *commands), *fence);
  wait_for(device, fence, "copying to or from the device");
}

}  // namespace

Allocation allocate(Device::State& device, const vk::MemoryRequirements& needs, bool prefer_host,
                    const std::string& name) {
  using Flag = vk::MemoryPropertyFlagBits;
  const auto host = Flag::eHostVisible | Flag::eHostCoherent;
  std::optional<std::uint32_t> type;
  if (prefer_host) {
    type = find_type(device, needs.memoryTypeBits, host | Flag::eHostCached);
    if (!type) type = find_type(device, needs.memoryTypeBits, host);
  } else {
    // Unified memory is both device-local and host-visible; a discrete card's small host-visible window is left to
    // buffers that need it.
    const bool unified = device.info.kind == "cpu" || device.info.kind == "integrated";
    if (unified) type = find_type(device, needs.memoryTypeBits, Flag::eDeviceLocal | host);
    if (!type) type = find_type(device, needs.memoryTypeBits, Flag::eDeviceLocal);
    if (!type) type = find_type(device, needs.memoryTypeBits, {});
  }
  if (!type) throw ResourceError("{}: the device has no memory type for it", name);
  Allocation allocation;
  try {
    allocation.memory = vk::raii::DeviceMemory(device.device, vk::MemoryAllocateInfo(needs.size, *type));
  } catch (const vk::SystemError&) {
    throw ResourceError(
        "{}: {} do not fit into the device's memory ({} are in use); try a smaller --size or fewer "
        "--light-samples",
        name, human(needs.size), human(device.allocated));
  }
  const auto flags = device.memory.memoryTypes[*type].propertyFlags;
  allocation.host_visible = (flags & host) == host;
  allocation.bytes = needs.size;
  device.account(static_cast<std::int64_t>(needs.size));
  return allocation;
}

Buffer::State::~State() {
  if (device != nullptr) device->account(-static_cast<std::int64_t>(allocation.bytes));
}

Buffer::Buffer(const Device& device, std::string name, std::uint64_t bytes, BufferUse use)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.name = std::move(name);
  PENUMBRA_ASSERT(bytes > 0, "buffer {} of no bytes", s.name);
  if (bytes > device.limits().max_storage_buffer_range) {
    throw ResourceError("{}: {} are more than this device's storage buffers can hold ({})", s.name, human(bytes),
                        human(device.limits().max_storage_buffer_range));
  }
  s.bytes = (bytes + 3) / 4 * 4;  // fills work on whole words
  using Usage = vk::BufferUsageFlagBits;
  vk::BufferUsageFlags usage = Usage::eStorageBuffer | Usage::eTransferSrc | Usage::eTransferDst |
                               Usage::eVertexBuffer | Usage::eIndexBuffer | Usage::eIndirectBuffer;
  if (use == BufferUse::texels) usage |= Usage::eUniformTexelBuffer;
  Device::State& d = device.state();
  try {
    s.buffer = make_vk_buffer(d, s.bytes, usage);
    s.allocation = allocate(d, s.buffer.getMemoryRequirements(), false, s.name);
    s.device = &d;
    s.buffer.bindMemory(*s.allocation.memory, 0);
    d.name(s.buffer, s.name);
    if (s.allocation.host_visible) s.mapped = s.allocation.memory.mapMemory(0, VK_WHOLE_SIZE);
    if (use == BufferUse::texels) {
      if (s.bytes / 16 > device.limits().max_texel_buffer_elements) {
        throw ResourceError("{}: {} texels are more than this device can read from one buffer ({})", s.name,
                            s.bytes / 16, device.limits().max_texel_buffer_elements);
      }
      s.view = vk::raii::BufferView(
          d.device, vk::BufferViewCreateInfo({}, *s.buffer, vk::Format::eR32G32B32A32Uint, 0, s.bytes / 16 * 16));
    }
  } catch (const vk::SystemError& error) {
    fail(error, fmt::format("making the buffer {}", s.name));
  }
}

Buffer::~Buffer() = default;
Buffer::Buffer(Buffer&&) noexcept = default;
Buffer& Buffer::operator=(Buffer&&) noexcept = default;

std::uint64_t Buffer::bytes() const {
  return state_->bytes;
}
const std::string& Buffer::name() const {
  return state_->name;
}

void Buffer::upload(std::span<const std::byte> data, std::uint64_t offset) const try {
  State& s = *state_;
  PENUMBRA_ASSERT(offset + data.size() <= s.bytes, "{}: {} + {} of {}", s.name, offset, data.size(), s.bytes);
  if (data.empty()) return;
  if (s.mapped != nullptr) {
    std::memcpy(static_cast<std::byte*>(s.mapped) + offset, data.data(), data.size());
    return;
  }
  auto staging = make_vk_buffer(*s.device, data.size(), vk::BufferUsageFlagBits::eTransferSrc);
  const Allocation memory = allocate(*s.device, staging.getMemoryRequirements(), true, "upload of " + s.name);
  staging.bindMemory(*memory.memory, 0);
  std::memcpy(memory.memory.mapMemory(0, VK_WHOLE_SIZE), data.data(), data.size());
  copy_and_wait(*s.device, *staging, *s.buffer, vk::BufferCopy(0, offset, data.size()));
  s.device->account(-static_cast<std::int64_t>(memory.bytes));
} catch (const vk::SystemError& error) {
  fail(error, fmt::format("filling the buffer {}", state_->name));
}

void Buffer::download(std::span<std::byte> data, std::uint64_t offset) const try {
  const State& s = *state_;
  PENUMBRA_ASSERT(offset + data.size() <= s.bytes, "{}: {} + {} of {}", s.name, offset, data.size(), s.bytes);
  if (data.empty()) return;
  if (s.mapped != nullptr) {
    std::memcpy(data.data(), static_cast<const std::byte*>(s.mapped) + offset, data.size());
    return;
  }
  auto staging = make_vk_buffer(*s.device, data.size(), vk::BufferUsageFlagBits::eTransferDst);
  const Allocation memory = allocate(*s.device, staging.getMemoryRequirements(), true, "read-back of " + s.name);
  staging.bindMemory(*memory.memory, 0);
  copy_and_wait(*s.device, *s.buffer, *staging, vk::BufferCopy(offset, 0, data.size()));
  std::memcpy(data.data(), memory.memory.mapMemory(0, VK_WHOLE_SIZE), data.size());
  s.device->account(-static_cast<std::int64_t>(memory.bytes));
} catch (const vk::SystemError& error) {
  fail(error, fmt::format("reading the buffer {}", state_->name));
}

bool grow(const Device& device, std::unique_ptr<Buffer>& buffer, const std::string& name, std::uint64_t bytes,
          BufferUse use) {
  if (buffer && buffer->bytes() >= bytes) return false;
  buffer.reset();  // freed before the new one is allocated: both together may not fit
  buffer = std::make_unique<Buffer>(device, name, bytes, use);
  return true;
}

}  // namespace penumbra::render
