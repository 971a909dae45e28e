// SPDX-License-Identifier: Apache-2.0
// Reads the bindings and push constants of a shader from its SPIR-V by SPIRV-Cross.

#include "base/assert.hpp"
#include "render/vulkan.hpp"

#include <spirv_cross/spirv_cross_c.h>

namespace penumbra::render {
namespace {

/// Owns all objects of SPIRV-Cross while one shader is read.
class CrossContext {
 public:
  CrossContext() { check(spvc_context_create(&context_)); }
  ~CrossContext() { spvc_context_destroy(context_); }
  CrossContext(const CrossContext&) = delete;
  CrossContext& operator=(const CrossContext&) = delete;

  void check(spvc_result result) const {
    PENUMBRA_ASSERT(result == SPVC_SUCCESS, "SPIRV-Cross: {}",
                    context_ == nullptr ? "no context" : spvc_context_get_last_error_string(context_));
  }
  [[nodiscard]] spvc_context get() const { return context_; }

 private:
  spvc_context context_ = nullptr;
};

}  // namespace

ShaderInterface reflect(std::span<const std::uint32_t> spirv, const std::string& name) {
  const CrossContext context;
  spvc_parsed_ir ir = nullptr;
  context.check(spvc_context_parse_spirv(context.get(), spirv.data(), spirv.size(), &ir));
  spvc_compiler compiler = nullptr;
  context.check(
      spvc_context_create_compiler(context.get(), SPVC_BACKEND_NONE, ir, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP, &compiler));
  spvc_resources resources = nullptr;
  context.check(spvc_compiler_create_shader_resources(compiler, &resources));

  std::vector<std::optional<vk::DescriptorType>> found;
  const auto collect = [&](spvc_resource_type type, vk::DescriptorType descriptor) {
    const spvc_reflected_resource* list = nullptr;
    std::size_t count = 0;
    context.check(spvc_resources_get_resource_list_for_type(resources, type, &list, &count));
    for (std::size_t i = 0; i < count; ++i) {
      PENUMBRA_ASSERT(spvc_compiler_get_decoration(compiler, list[i].id, SpvDecorationDescriptorSet) == 0,
                      "{}: {} is not in set 0", name, list[i].name);
      const auto binding = spvc_compiler_get_decoration(compiler, list[i].id, SpvDecorationBinding);
      if (found.size() <= binding) found.resize(binding + 1);
      PENUMBRA_ASSERT(!found[binding] || *found[binding] == descriptor, "{}: binding {} has two types", name, binding);
      found[binding] = descriptor;
    }
  };
  collect(SPVC_RESOURCE_TYPE_STORAGE_BUFFER, vk::DescriptorType::eStorageBuffer);
  collect(SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, vk::DescriptorType::eUniformBuffer);
  collect(SPVC_RESOURCE_TYPE_SAMPLED_IMAGE, vk::DescriptorType::eCombinedImageSampler);
  collect(SPVC_RESOURCE_TYPE_SEPARATE_IMAGE, vk::DescriptorType::eUniformTexelBuffer);

  ShaderInterface shader;
  for (std::size_t i = 0; i < found.size(); ++i) {
    PENUMBRA_ASSERT(found[i].has_value(), "{}: binding {} is not used; bindings are 0 … n−1", name, i);
    shader.bindings.push_back(*found[i]);
  }
  const spvc_reflected_resource* push = nullptr;
  std::size_t push_count = 0;
  context.check(
      spvc_resources_get_resource_list_for_type(resources, SPVC_RESOURCE_TYPE_PUSH_CONSTANT, &push, &push_count));
  if (push_count > 0) {
    std::size_t bytes = 0;
    context.check(spvc_compiler_get_declared_struct_size(
        compiler, spvc_compiler_get_type_handle(compiler, push->base_type_id), &bytes));
    shader.push_bytes = static_cast<std::uint32_t>(bytes);
  }
  return shader;
}

}  // namespace penumbra::render
