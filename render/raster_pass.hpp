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

/// A 32-bit float depth image to rasterise into; 1 is far.
class DepthTarget {
 public:
  DepthTarget(const Device& device, const std::string& name, std::uint32_t width, std::uint32_t height);
  ~DepthTarget();
  DepthTarget(DepthTarget&&) noexcept;
  DepthTarget& operator=(DepthTarget&&) noexcept;

  [[nodiscard]] std::uint32_t width() const;
  [[nodiscard]] std::uint32_t height() const;
  /// Copies the depths, row by row, into `to` (width · height floats) at `offset` bytes.
  void copy_to(Commands& commands, const Buffer& to, std::uint64_t offset = 0) const;

  struct State;
  [[nodiscard]] State& state() const { return *state_; }  ///< for render/*.cpp only

 private:
  std::unique_ptr<State> state_;
};

/// Fragments that a depth test keeps, by comparison with the stored depth.
enum class DepthCompare : std::uint8_t { less, greater };

/// Triangles that are culled, by their visible side: front is counter-clockwise on the screen, y down.
enum class Cull : std::uint8_t { none, front, back };

struct RasterPassOptions {
  std::string name;  ///< labels timestamps, debug regions and errors
  std::span<const std::uint32_t> vertex;
  std::span<const std::uint32_t> fragment;  ///< may be empty: depth only
  std::uint32_t push_bytes = 0;             ///< sizeof the push-constant struct; checked against the shaders
  std::vector<std::uint32_t> constants{};   ///< specialization constants 0, 1, 2 … of both stages
  bool triangle_strip = false;              ///< else a triangle list
  bool depth = false;                       ///< tests and writes a DepthTarget
  DepthCompare compare = DepthCompare::less;
  Cull cull = Cull::none;
};

/// A graphics pipeline without vertex inputs or colours: vertices are read from storage buffers, results go to depth or
/// to storage buffers. As in ComputePass, bindings and push constants are reflected and checked, and the device caches
/// the pipeline.
class RasterPass {
 public:
  RasterPass(const Device& device, const RasterPassOptions& options);
  ~RasterPass();
  RasterPass(RasterPass&&) noexcept;
  RasterPass& operator=(RasterPass&&) noexcept;

  struct Draw {
    std::uint32_t width = 0, height = 0;  ///< of the viewport, which starts at (0, 0)
    std::uint32_t vertices = 0, instances = 1;
    const DepthTarget* depth = nullptr;  ///< non-null exactly if the pass has depth
    bool clear = true;                   ///< sets depth to 1 before, or to 0 if greater depths are kept
  };

  /// Records a draw. Buffers in binding order.
  template <typename Push>
  requires(std::is_trivially_copyable_v<Push> && !std::is_same_v<Push, std::span<const std::byte>>) void record(
      Commands& commands, const Push& push, std::initializer_list<BufferReference> buffers, const Draw& draw) const {
    record(commands, std::as_bytes(std::span(&push, 1)), BufferList(buffers.begin(), buffers.size()), draw);
  }
  /// Overload for push constants and lists that are assembled at run time.
  void record(Commands& commands, std::span<const std::byte> push, BufferList buffers, const Draw& draw) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::render
