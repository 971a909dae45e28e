// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/commands.hpp"

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace penumbra::render {

/// Options of a compute pass.
struct ComputePassOptions {
  std::string name;  ///< labels timestamps, debug regions and errors
  std::span<const std::uint32_t> spirv;
  std::uint32_t push_bytes = 0;  ///< sizeof the push-constant struct; checked against the shader
  /// Specialization constants 0, 1, 2 …; the pass sets one more by itself (render/group_order.glsl).
  std::vector<std::uint32_t> constants{};
  bool full_subgroups = false;  ///< the workgroup is a whole number of subgroups of Limits::subgroup_size
};

/// A compute pipeline whose bindings (set 0, storage and uniform texel buffers, binding 0 … n−1) and push-constant size
/// are read from its SPIR-V and checked on construction and on recording. Recording allocates descriptors but does not
/// wait. The device caches the pipeline: another pass from the same options is made immediately.
class ComputePass {
 public:
  ComputePass(const Device& device, const ComputePassOptions& options);
  ~ComputePass();
  ComputePass(ComputePass&&) noexcept;
  ComputePass& operator=(ComputePass&&) noexcept;

  /// Dispatches `groups` workgroups in x (split over y when the device's limit is smaller: shaders read
  /// gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x). Buffers in binding order.
  template <typename Push>
  requires(std::is_trivially_copyable_v<Push> && !std::is_same_v<Push, std::span<const std::byte>>) void record(
      Commands& commands, const Push& push, std::initializer_list<BufferReference> buffers,
      std::uint64_t groups) const {
    record(commands, std::as_bytes(std::span(&push, 1)), BufferList(buffers.begin(), buffers.size()), groups);
  }
  /// Overload for push constants and lists that are assembled at run time.
  void record(Commands& commands, std::span<const std::byte> push, BufferList buffers, std::uint64_t groups) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::render
