#pragma once

#include "render/commands.hpp"

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace penumbra::render {

/// What a compute pass is made from.
struct ComputePassOptions {
  std::string name;  ///< labels timestamps, debug regions and errors
  std::span<const std::uint32_t> spirv;
  std::uint32_t push_bytes = 0;            ///< sizeof the push-constant struct; checked against the shader
  std::vector<std::uint32_t> constants{};  ///< specialization constants 0, 1, 2 …
  bool full_subgroups = false;             ///< the workgroup is a whole number of subgroups of Limits::subgroup_size
};

/// A compute pipeline whose bindings (set 0, storage and uniform texel buffers, binding 0 … n−1) and push-constant size
/// are read from its SPIR-V and checked when it is built and when it is recorded. Records only: no allocation, no wait.
class ComputePass {
 public:
  ComputePass(const Device& device, const ComputePassOptions& options);
  ~ComputePass();
  ComputePass(ComputePass&&) noexcept;
  ComputePass& operator=(ComputePass&&) noexcept;

  /// Dispatches `groups` workgroups in x (split over y when the device's limit is smaller: shaders read
  /// gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x). Buffers in binding order.
  template <typename Push>
  void record(Commands& commands, const Push& push, std::initializer_list<std::reference_wrapper<const Buffer>> buffers,
              std::uint64_t groups) const {
    static_assert(std::is_trivially_copyable_v<Push>);
    record_bytes(commands, std::as_bytes(std::span(&push, 1)), buffers, groups);
  }

 private:
  void record_bytes(Commands& commands, std::span<const std::byte> push,
                    std::initializer_list<std::reference_wrapper<const Buffer>> buffers, std::uint64_t groups) const;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::render
