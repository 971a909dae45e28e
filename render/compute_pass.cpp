// SPDX-License-Identifier: Apache-2.0
// Compute pipelines, compiled once per device for each name, code and specialization. If there are more workgroups than
// one dimension can have, they are laid out in two.

#include "render/compute_pass.hpp"

#include "base/assert.hpp"
#include "render/features.hpp"
#include "render/group_order.shared.h"
#include "render/pipelines.hpp"

#include <algorithm>
#include <utility>

namespace penumbra::render {

namespace {

KeptPipeline make_pipeline(const Device& device, const ComputePassOptions& options) {
  Device::State& state = device.state();
  KeptPipeline made;
  require_features(device.info(), options.spirv, options.name);
  const ShaderInterface shader = reflect(options.spirv, options.name);
  made.push_bytes = shader.push_bytes;
  if (state.only_checks) return made;
  made.bindings = Bindings(state, options.name, shader, vk::ShaderStageFlagBits::eCompute);

  const vk::raii::Device& d = state.device;
  const NumberedConstant strips{gpu::kStripsConstant, device.info().kind == "cpu" ? gpu::kStripsOnProcessor : 1};
  const SpecializationConstants constants(options.constants, std::span(&strips, 1));
  const vk::raii::ShaderModule module(d,
                                      vk::ShaderModuleCreateInfo({}, options.spirv.size_bytes(), options.spirv.data()));
  const vk::PipelineShaderStageRequiredSubgroupSizeCreateInfo subgroup(device.limits().subgroup_size);
  const auto properties =
      state.physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan13Properties>()
          .get<vk::PhysicalDeviceVulkan13Properties>();
  // A device with a variable subgroup size is pinned to the size in Limits; a fixed size needs no pinning.
  const bool pin = options.full_subgroups && properties.minSubgroupSize != properties.maxSubgroupSize &&
                   (properties.requiredSubgroupSizeStages & vk::ShaderStageFlagBits::eCompute);
  const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main", constants.get(),
                                                pin ? &subgroup : nullptr);
  made.pipeline = vk::raii::Pipeline(d, state.cache, vk::ComputePipelineCreateInfo({}, stage, made.bindings.layout()));
  state.name(made.pipeline, options.name);
  return made;
}

const KeptPipeline& pipeline_of(const Device& device, const ComputePassOptions& options) {
  PipelineKey key(options.name, {options.full_subgroups ? 1U : 0U});
  key.add(options.constants).add(options.spirv);
  return pipelines_of(device.state()).find(std::move(key), [&] { return make_pipeline(device, options); });
}

}  // namespace

struct ComputePass::State {
  Device::State* device = nullptr;
  std::string name;
  const KeptPipeline* pipeline = nullptr;
};

ComputePass::ComputePass(const Device& device, const ComputePassOptions& options) try
    : state_(std::make_unique<State>(
          State{.device = &device.state(), .name = options.name, .pipeline = &pipeline_of(device, options)})) {
  PENUMBRA_ASSERT(state_->pipeline->push_bytes == options.push_bytes,
                  "{}: the shader's push constants have {} bytes, C++'s {}", options.name, state_->pipeline->push_bytes,
                  options.push_bytes);
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
  s.pipeline->bindings.bind(c, vk::PipelineBindPoint::eCompute, push, buffers);
  c.commands.bindPipeline(vk::PipelineBindPoint::eCompute, *s.pipeline->pipeline);
  const std::uint64_t limit = std::min<std::uint64_t>(s.device->limits.max_workgroup_count, 65535);
  const std::uint64_t y = (groups + limit - 1) / limit;
  const std::uint64_t x = (groups + y - 1) / y;
  c.commands.dispatch(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 1);
  c.close_pass();
}

}  // namespace penumbra::render
