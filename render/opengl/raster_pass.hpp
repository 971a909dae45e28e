// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/opengl/context.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace penumbra::render::opengl {

/// Memory that shaders read and write.
class Buffer {
 public:
  /// Content is undefined. Throws ResourceError for a size above a shader block's limit, or if memory is short.
  Buffer(const Context& context, std::string name, std::uint64_t bytes);
  ~Buffer();
  Buffer(Buffer&&) noexcept;
  Buffer& operator=(Buffer&&) noexcept;

  [[nodiscard]] std::uint64_t bytes() const;
  template <typename T>
  void write(std::span<const T> values, std::uint64_t offset = 0) const {
    upload(std::as_bytes(values), offset);
  }
  template <typename T>
  void read(std::span<T> values, std::uint64_t offset = 0) const {
    download(std::as_writable_bytes(values), offset);
  }

  struct State;
  [[nodiscard]] State& state() const { return *state_; }  ///< for render/opengl/*.cpp only

 private:
  void upload(std::span<const std::byte> data, std::uint64_t offset) const;
  void download(std::span<std::byte> data, std::uint64_t offset) const;
  std::unique_ptr<State> state_;
};

/// A 32-bit float depth image.
class DepthTarget {
 public:
  /// Throws ResourceError for a size above the driver's limit.
  DepthTarget(const Context& context, const std::string& name, std::uint32_t width, std::uint32_t height);
  ~DepthTarget();
  DepthTarget(DepthTarget&&) noexcept;
  DepthTarget& operator=(DepthTarget&&) noexcept;

  /// Reads the depths, width · height of them, the row of the smallest y first.
  void read(std::span<float> depths) const;

  struct State;
  [[nodiscard]] State& state() const { return *state_; }  ///< for render/opengl/*.cpp only

 private:
  std::unique_ptr<State> state_;
};

struct RasterPassOptions {
  std::string name;
  /// GLSL 4.50. Vulkan's push constants are the uniform block at binding 0 (std140); buffers are storage blocks,
  /// std430, from binding 0 on.
  std::string_view vertex, fragment;
  bool triangle_strip = false;  ///< else a triangle list
  bool depth = false;           ///< tests and writes a DepthTarget
  bool keep_greater = false;    ///< keeps the greater of two depths, else the smaller
};

/// OpenGL's equivalent of render::RasterPass: no vertex inputs, no colours. As in Vulkan, y = −1 is the first row and
/// depths are clipped to 0 … w.
class RasterPass {
 public:
  /// Throws ResourceError with the compiler's message if the driver refuses a shader.
  RasterPass(const Context& context, const RasterPassOptions& options);
  ~RasterPass();
  RasterPass(RasterPass&&) noexcept;
  RasterPass& operator=(RasterPass&&) noexcept;

  struct Draw {
    std::uint32_t width = 0, height = 0;  ///< of the viewport, which starts at (0, 0)
    std::uint32_t vertices = 0, instances = 1;
    const DepthTarget* depth = nullptr;  ///< non-null exactly if the pass has depth
    bool clear = true;                   ///< sets depth to 1 before, or to 0 if greater depths are kept
  };

  /// Draws immediately. Buffers in binding order.
  template <typename Push>
  requires(std::is_trivially_copyable_v<Push>) void draw(
      const Push& push, std::initializer_list<std::reference_wrapper<const Buffer>> buffers, const Draw& draw) const {
    run(std::as_bytes(std::span(&push, 1)), buffers, draw);
  }

  struct State;

 private:
  void run(std::span<const std::byte> push, std::initializer_list<std::reference_wrapper<const Buffer>> buffers,
           const Draw& draw) const;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::render::opengl
