#include "render/compute_pass.hpp"

#include "base/assert.hpp"
#include "render/bindings.hpp"

#include <algorithm>

namespace penumbra::render {

struct ComputePass::State {
  Device::State* device = nullptr;
  std::string name;
  Bindings bindings;
  vk::raii::Pipeline pipeline{nullptr};
};

ComputePass::ComputePass(const Device& device, const ComputePassOptions& options) try
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.device = &device.state();
  s.name = options.name;
  const ShaderInterface shader = reflect(options.spirv, options.name);
  PENUMBRA_ASSERT(shader.push_bytes == options.push_bytes, "{}: the shader's push constants have {} bytes, C++'s {}",
                  s.name, shader.push_bytes, options.push_bytes);
  s.bindings = Bindings(*s.device, s.name, shader, vk::ShaderStageFlagBits::eCompute);

  const vk::raii::Device& d = s.device->device;
  const SpecializationConstants constants(options.constants);
  const vk::raii::ShaderModule module(d,
                                      vk::ShaderModuleCreateInfo({}, options.spirv.size_bytes(), options.spirv.data()));
  const vk::PipelineShaderStageRequiredSubgroupSizeCreateInfo subgroup(device.limits().subgroup_size);
  const auto properties =
      s.device->physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan13Properties>()
          .get<vk::PhysicalDeviceVulkan13Properties>();
  // A device whose subgroup size varies is pinned to the one that Limits states; one whose size is fixed need not be.
  const bool pin = options.full_subgroups && properties.minSubgroupSize != properties.maxSubgroupSize &&
                   (properties.requiredSubgroupSizeStages & vk::ShaderStageFlagBits::eCompute);
  const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main", constants.get(),
                                                pin ? &subgroup : nullptr);
  s.pipeline = vk::raii::Pipeline(d, s.device->cache, vk::ComputePipelineCreateInfo({}, stage, s.bindings.layout()));
  s.device->name(s.pipeline, s.name);
} catch (const vk::SystemError& error) {
  fail(error, fmt::format("building the pass {}", options.name));
}

ComputePass::~ComputePass() = default;
ComputePass::ComputePass(ComputePass&&) noexcept = default;
ComputePass& ComputePass::operator=(ComputePass&&) noexcept = default;

void ComputePass::record(Commands& commands, std::span<const std::byte> push, BufferList buffers,
                         std::uint64_t groups) const {
  const State& s = *state_;
  if (groups == 0) return;
  Commands::State& c = commands.state();
  c.open_pass(s.name);
  s.bindings.bind(c, vk::PipelineBindPoint::eCompute, push, buffers);
  c.commands.bindPipeline(vk::PipelineBindPoint::eCompute, *s.pipeline);
  const std::uint64_t limit = std::min<std::uint64_t>(s.device->limits.max_workgroup_count, 65535);
  const std::uint64_t y = (groups + limit - 1) / limit;
  const std::uint64_t x = (groups + y - 1) / y;
  c.commands.dispatch(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 1);
  c.close_pass();
}

}  // namespace penumbra::render
