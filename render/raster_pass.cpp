// SPDX-License-Identifier: Apache-2.0
// Depth images of 32-bit floats, whose rows can be copied to buffers, and raster passes (dynamic rendering) with such
// an image or without.

#include "render/raster_pass.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "render/features.hpp"
#include "render/pipelines.hpp"

namespace penumbra::render {

struct DepthTarget::State {
  Device::State* device = nullptr;
  vk::raii::Image image{nullptr};
  Allocation allocation;
  vk::raii::ImageView view{nullptr};
  std::uint32_t width = 0, height = 0;
  bool fresh = true;  // its layout is still undefined
  ~State() {
    if (device != nullptr) device->account(-static_cast<std::int64_t>(allocation.bytes));
  }
};

DepthTarget::DepthTarget(const Device& device, const std::string& name, std::uint32_t width, std::uint32_t height) try
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  Device::State& d = device.state();
  if (std::max(width, height) > device.limits().max_image_size) {
    throw ResourceError("{}: {}×{} is more than this device's largest image ({})", name, width, height,
                        device.limits().max_image_size);
  }
  s.width = width;
  s.height = height;
  constexpr auto kFormat = vk::Format::eD32Sfloat;
  s.image = vk::raii::Image(
      d.device,
      vk::ImageCreateInfo({}, vk::ImageType::e2D, kFormat, vk::Extent3D(width, height, 1), 1, 1,
                          vk::SampleCountFlagBits::e1, vk::ImageTiling::eOptimal,
                          vk::ImageUsageFlagBits::eDepthStencilAttachment | vk::ImageUsageFlagBits::eTransferSrc));
  s.allocation = allocate(d, s.image.getMemoryRequirements(), false, name);
  s.device = &d;
  s.image.bindMemory(*s.allocation.memory, 0);
  s.view = vk::raii::ImageView(
      d.device, vk::ImageViewCreateInfo({}, *s.image, vk::ImageViewType::e2D, kFormat, {},
                                        vk::ImageSubresourceRange(vk::ImageAspectFlagBits::eDepth, 0, 1, 0, 1)));
  d.name(s.image, name);
} catch (const vk::SystemError& error) {
  fail(error, fmt::format("making the depth image {}", name));
}

DepthTarget::~DepthTarget() = default;
DepthTarget::DepthTarget(DepthTarget&&) noexcept = default;
DepthTarget& DepthTarget::operator=(DepthTarget&&) noexcept = default;
std::uint32_t DepthTarget::width() const {
  return state_->width;
}
std::uint32_t DepthTarget::height() const {
  return state_->height;
}

namespace {

/// Changes an image's layout with a full barrier: earlier commands finish before, and are visible to, later ones.
void change_layout(Commands::State& commands, vk::Image image, vk::ImageLayout from, vk::ImageLayout to) {
  const vk::ImageMemoryBarrier2 barrier(vk::PipelineStageFlagBits2::eAllCommands, vk::AccessFlagBits2::eMemoryWrite,
                                        vk::PipelineStageFlagBits2::eAllCommands,
                                        vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite, from, to,
                                        VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, image,
                                        vk::ImageSubresourceRange(vk::ImageAspectFlagBits::eDepth, 0, 1, 0, 1));
  commands.commands.pipelineBarrier2(vk::DependencyInfo({}, {}, {}, barrier));
}

vk::CullModeFlags culling(Cull cull) {
  switch (cull) {
    case Cull::none:
      return vk::CullModeFlagBits::eNone;
    case Cull::front:
      return vk::CullModeFlagBits::eFront;
    case Cull::back:
      return vk::CullModeFlagBits::eBack;
  }
  return vk::CullModeFlagBits::eNone;
}

}  // namespace

void DepthTarget::copy_to(Commands& commands, const Buffer& to, std::uint64_t offset) const {
  Commands::State& c = commands.state();
  c.open_pass("copy depth");
  change_layout(c, *state_->image, vk::ImageLayout::eDepthAttachmentOptimal, vk::ImageLayout::eTransferSrcOptimal);
  const vk::BufferImageCopy region(offset, 0, 0, vk::ImageSubresourceLayers(vk::ImageAspectFlagBits::eDepth, 0, 0, 1),
                                   {}, vk::Extent3D(state_->width, state_->height, 1));
  c.commands.copyImageToBuffer(*state_->image, vk::ImageLayout::eTransferSrcOptimal, *to.state().buffer, region);
  change_layout(c, *state_->image, vk::ImageLayout::eTransferSrcOptimal, vk::ImageLayout::eDepthAttachmentOptimal);
  c.close_pass();
}

struct RasterPass::State {
  std::string name;
  bool depth = false;
  float cleared = 1;  // depth before the first draw
  const KeptPipeline* pipeline = nullptr;
};

namespace {

KeptPipeline make_pipeline(const Device& device, const RasterPassOptions& options) {
  Device::State& state = device.state();
  require_features(device.info(), options.vertex, options.name);
  require_features(device.info(), options.fragment, options.name);
  // The two stages share one set; a stage may use fewer bindings than the other.
  ShaderInterface shader = reflect(options.vertex, options.name);
  if (!options.fragment.empty()) {
    const ShaderInterface fragment = reflect(options.fragment, options.name);
    shader.push_bytes = std::max(shader.push_bytes, fragment.push_bytes);
    if (fragment.bindings.size() > shader.bindings.size()) shader.bindings = fragment.bindings;
  }
  KeptPipeline made;
  made.push_bytes = shader.push_bytes;
  if (state.only_checks) return made;
  made.bindings =
      Bindings(state, options.name, shader, vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment);

  const vk::raii::Device& d = state.device;
  const SpecializationConstants constants(options.constants);
  const vk::raii::ShaderModule vertex(
      d, vk::ShaderModuleCreateInfo({}, options.vertex.size_bytes(), options.vertex.data()));
  vk::raii::ShaderModule fragment(nullptr);
  std::vector<vk::PipelineShaderStageCreateInfo> stages;
  stages.emplace_back(vk::PipelineShaderStageCreateFlags(), vk::ShaderStageFlagBits::eVertex, *vertex, "main",
                      constants.get());
  if (!options.fragment.empty()) {
    fragment = vk::raii::ShaderModule(
        d, vk::ShaderModuleCreateInfo({}, options.fragment.size_bytes(), options.fragment.data()));
    stages.emplace_back(vk::PipelineShaderStageCreateFlags(), vk::ShaderStageFlagBits::eFragment, *fragment, "main",
                        constants.get());
  }
  const vk::PipelineVertexInputStateCreateInfo no_inputs;
  const vk::PipelineInputAssemblyStateCreateInfo assembly(
      {}, options.triangle_strip ? vk::PrimitiveTopology::eTriangleStrip : vk::PrimitiveTopology::eTriangleList);
  const vk::PipelineViewportStateCreateInfo viewport({}, 1, nullptr, 1, nullptr);
  const vk::PipelineRasterizationStateCreateInfo raster({}, VK_FALSE, VK_FALSE, vk::PolygonMode::eFill,
                                                        culling(options.cull), vk::FrontFace::eCounterClockwise,
                                                        VK_FALSE, 0, 0, 0, 1.0F);
  const vk::PipelineMultisampleStateCreateInfo multisample({}, vk::SampleCountFlagBits::e1);
  const bool keep_greater = options.compare == DepthCompare::greater;
  const vk::PipelineDepthStencilStateCreateInfo depth({}, options.depth, options.depth,
                                                      keep_greater ? vk::CompareOp::eGreater : vk::CompareOp::eLess);
  const vk::PipelineColorBlendStateCreateInfo blend;
  const std::array dynamic{vk::DynamicState::eViewport, vk::DynamicState::eScissor};
  const vk::PipelineDynamicStateCreateInfo dynamic_state({}, dynamic);
  vk::StructureChain<vk::GraphicsPipelineCreateInfo, vk::PipelineRenderingCreateInfo> chain(
      vk::GraphicsPipelineCreateInfo({}, stages, &no_inputs, &assembly, nullptr, &viewport, &raster, &multisample,
                                     &depth, &blend, &dynamic_state, made.bindings.layout()),
      vk::PipelineRenderingCreateInfo(0, {}, options.depth ? vk::Format::eD32Sfloat : vk::Format::eUndefined));
  made.pipeline = vk::raii::Pipeline(d, state.cache, chain.get<vk::GraphicsPipelineCreateInfo>());
  state.name(made.pipeline, options.name);
  return made;
}

const KeptPipeline& pipeline_of(const Device& device, const RasterPassOptions& options) {
  PipelineKey key(options.name,
                  {options.triangle_strip ? 1U : 0U, options.depth ? 1U : 0U,
                   static_cast<std::uint32_t>(options.compare), static_cast<std::uint32_t>(options.cull)});
  key.add(options.constants).add(options.vertex).add(options.fragment);
  return pipelines_of(device.state()).find(std::move(key), [&] { return make_pipeline(device, options); });
}

}  // namespace

RasterPass::RasterPass(const Device& device, const RasterPassOptions& options) try
    : state_(std::make_unique<State>(State{.name = options.name,
                                           .depth = options.depth,
                                           .cleared = options.compare == DepthCompare::greater ? 0.0F : 1.0F,
                                           .pipeline = &pipeline_of(device, options)})) {
  PENUMBRA_ASSERT(state_->pipeline->push_bytes == options.push_bytes,
                  "{}: the shaders' push constants have {} bytes, C++'s {}", options.name, state_->pipeline->push_bytes,
                  options.push_bytes);
} catch (const vk::SystemError& error) {
  fail(error, fmt::format("building the pass {}", options.name));
}

RasterPass::~RasterPass() = default;
RasterPass::RasterPass(RasterPass&&) noexcept = default;
RasterPass& RasterPass::operator=(RasterPass&&) noexcept = default;

void RasterPass::record(Commands& commands, std::span<const std::byte> push, BufferList buffers,
                        const Draw& draw) const {
  const State& s = *state_;
  PENUMBRA_ASSERT(s.depth == (draw.depth != nullptr), "{}: depth target given: {}", s.name, draw.depth != nullptr);
  Commands::State& c = commands.state();
  c.open_pass(s.name);
  s.pipeline->bindings.bind(c, vk::PipelineBindPoint::eGraphics, push, buffers);

  vk::RenderingAttachmentInfo depth;
  const vk::Rect2D area({0, 0}, {draw.width, draw.height});
  vk::RenderingInfo rendering({}, area, 1);
  if (draw.depth != nullptr) {
    DepthTarget::State& target = draw.depth->state();
    if (target.fresh) {
      change_layout(c, *target.image, vk::ImageLayout::eUndefined, vk::ImageLayout::eDepthAttachmentOptimal);
      target.fresh = false;
    }
    depth = vk::RenderingAttachmentInfo(*target.view, vk::ImageLayout::eDepthAttachmentOptimal,
                                        vk::ResolveModeFlagBits::eNone, {}, {},
                                        draw.clear ? vk::AttachmentLoadOp::eClear : vk::AttachmentLoadOp::eLoad,
                                        vk::AttachmentStoreOp::eStore, vk::ClearDepthStencilValue(s.cleared, 0));
    rendering.setPDepthAttachment(&depth);
  }
  c.commands.beginRendering(rendering);
  c.commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *s.pipeline->pipeline);
  c.commands.setViewport(0, vk::Viewport(0, 0, static_cast<float>(draw.width), static_cast<float>(draw.height), 0, 1));
  c.commands.setScissor(0, area);
  c.commands.draw(draw.vertices, draw.instances, 0, 0);
  c.commands.endRendering();
  c.close_pass();
}

}  // namespace penumbra::render
