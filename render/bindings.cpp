// SPDX-License-Identifier: Apache-2.0
// Descriptor sets of one pipeline, made from the declarations in its shaders. Each bind takes a separate pool, which
// lives as long as the commands' recording.

#include "render/bindings.hpp"

#include "base/assert.hpp"

namespace penumbra::render {

Bindings::Bindings(Device::State& device, std::string name, const ShaderInterface& shader, vk::ShaderStageFlags stages)
    : device_(&device), name_(std::move(name)), shader_(shader), stages_(stages) {
  const vk::raii::Device& d = device.device;
  std::vector<vk::DescriptorSetLayoutBinding> bindings;
  for (std::uint32_t i = 0; i < shader.bindings.size(); ++i) bindings.emplace_back(i, shader.bindings[i], 1, stages);
  set_layout_ = vk::raii::DescriptorSetLayout(d, vk::DescriptorSetLayoutCreateInfo({}, bindings));
  const vk::PushConstantRange range(stages, 0, shader.push_bytes);
  vk::PipelineLayoutCreateInfo layout({}, *set_layout_);
  if (shader.push_bytes > 0) layout.setPushConstantRanges(range);
  layout_ = vk::raii::PipelineLayout(d, layout);
}

void Bindings::bind(Commands::State& commands, vk::PipelineBindPoint point, std::span<const std::byte> push,
                    BufferList buffers) const {
  PENUMBRA_ASSERT(buffers.size() == shader_.bindings.size(), "{}: {} buffers for {} bindings", name_, buffers.size(),
                  shader_.bindings.size());
  PENUMBRA_ASSERT(push.size() == shader_.push_bytes, "{}: {} bytes of push constants for {}", name_, push.size(),
                  shader_.push_bytes);
  const vk::raii::Device& d = device_->device;
  if (!buffers.empty()) {
    const auto count = static_cast<std::uint32_t>(buffers.size());
    const std::array sizes{vk::DescriptorPoolSize(vk::DescriptorType::eStorageBuffer, count),
                           vk::DescriptorPoolSize(vk::DescriptorType::eUniformTexelBuffer, count)};
    commands.pools.emplace_back(d, vk::DescriptorPoolCreateInfo({}, 1, sizes));
    const vk::DescriptorSetAllocateInfo info(*commands.pools.back(), *set_layout_);
    // The set is freed with its pool, not by itself.
    const vk::DescriptorSet set = (*d).allocateDescriptorSets(info, *d.getDispatcher()).front();
    std::vector<vk::DescriptorBufferInfo> infos;
    std::vector<vk::BufferView> views;
    infos.reserve(count);
    views.reserve(count);
    std::vector<vk::WriteDescriptorSet> writes;
    for (std::uint32_t binding = 0; const Buffer& buffer : buffers) {
      const auto type = shader_.bindings[binding];
      vk::WriteDescriptorSet write(set, binding++, 0, 1, type);
      if (type == vk::DescriptorType::eUniformTexelBuffer) {
        PENUMBRA_ASSERT(*buffer.state().view, "{}: {} is bound as texels but was not made for them", name_,
                        buffer.name());
        views.push_back(*buffer.state().view);
        write.setPTexelBufferView(&views.back());
      } else {
        infos.emplace_back(*buffer.state().buffer, 0, VK_WHOLE_SIZE);
        write.setPBufferInfo(&infos.back());
      }
      writes.push_back(write);
    }
    d.updateDescriptorSets(writes, {});
    commands.commands.bindDescriptorSets(point, *layout_, 0, set, {});
  }
  if (!push.empty()) {
    commands.commands.pushConstants<std::byte>(
        *layout_, stages_, 0, vk::ArrayProxy<const std::byte>(static_cast<std::uint32_t>(push.size()), push.data()));
  }
}

SpecializationConstants::SpecializationConstants(std::vector<std::uint32_t> values,
                                                 std::span<const NumberedConstant> others)
    : values_(std::move(values)) {
  constexpr std::uint32_t kBytes = sizeof(std::uint32_t);
  for (std::uint32_t i = 0; i < values_.size(); ++i) entries_.emplace_back(i, i * kBytes, kBytes);
  for (const NumberedConstant& other : others) {
    entries_.emplace_back(other.id, static_cast<std::uint32_t>(values_.size()) * kBytes, kBytes);
    values_.push_back(other.value);
  }
  info_.setMapEntries(entries_).setData<std::uint32_t>(values_);
}

}  // namespace penumbra::render
