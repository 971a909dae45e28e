// SPDX-License-Identifier: Apache-2.0
#pragma once
// Inside render/ only.

#include "render/vulkan.hpp"

#include <span>
#include <string>
#include <vector>

namespace penumbra::render {

/// The descriptor set and push constants of one pipeline, as its shaders declare them. All bound objects are checked
/// against the declaration.
class Bindings {
 public:
  Bindings() = default;
  Bindings(Device::State& device, std::string name, const ShaderInterface& shader, vk::ShaderStageFlags stages);

  /// Binds buffers (in binding order) and push constants for the commands recorded next.
  void bind(Commands::State& commands, vk::PipelineBindPoint point, std::span<const std::byte> push,
            BufferList buffers) const;
  [[nodiscard]] vk::PipelineLayout layout() const { return *layout_; }

 private:
  Device::State* device_ = nullptr;
  std::string name_;
  ShaderInterface shader_;
  vk::ShaderStageFlags stages_;
  vk::raii::DescriptorSetLayout set_layout_{nullptr};
  vk::raii::PipelineLayout layout_{nullptr};
};

/// A specialization constant by its number in the shader.
struct NumberedConstant {
  std::uint32_t id, value;
};

/// Specialization constants in Vulkan's form: 0, 1, 2 … and others by their numbers.
class SpecializationConstants {
 public:
  explicit SpecializationConstants(std::vector<std::uint32_t> values, std::span<const NumberedConstant> others = {});
  SpecializationConstants(const SpecializationConstants&) = delete;
  SpecializationConstants& operator=(const SpecializationConstants&) = delete;
  [[nodiscard]] const vk::SpecializationInfo* get() const { return &info_; }

 private:
  std::vector<std::uint32_t> values_;
  std::vector<vk::SpecializationMapEntry> entries_;
  vk::SpecializationInfo info_;
};

}  // namespace penumbra::render
