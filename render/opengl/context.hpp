// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

/// A second rasteriser: OpenGL 4.5 (core) on an EGL context without a surface, so that no display is needed.
/// Independent of shadows and of Vulkan.
namespace penumbra::render::opengl {

/// Description of OpenGL on one EGL device, with the reason why it cannot be used, if any.
struct ContextInfo {
  std::uint32_t index = 0;
  std::string platform;  ///< EGL platform used: "device 0", or "surfaceless"
  std::string name;      ///< the renderer's name, or the platform's if there is no context
  std::string kind;      ///< "cpu" or "gpu"
  std::string driver;    ///< vendor and version
  std::vector<std::string> refusals;
  std::uint32_t subpixel_bits = 0;  ///< GL_SUBPIXEL_BITS: corners are snapped to 2^-bits of a pixel
  std::uint32_t max_image_size = 0;
  std::uint64_t max_storage_block = 0;

  [[nodiscard]] bool usable() const { return refusals.empty(); }
};

/// Returns the contexts of this machine. If there are none, one entry has the reason: a build without OpenGL, or no EGL
/// driver. Never throws.
std::vector<ContextInfo> list_contexts();

/// A context without a surface. Made current by each user, on one thread at a time, and released afterwards.
class Context {
 public:
  /// Makes the first usable context; if several are, one on the processor if `on_processor`, else not. Throws
  /// ResourceError with the reason why each was refused.
  explicit Context(bool on_processor);
  ~Context();
  Context(Context&&) noexcept;
  Context& operator=(Context&&) noexcept;

  [[nodiscard]] const ContextInfo& info() const;

  struct State;
  [[nodiscard]] State& state() const { return *state_; }  ///< for render/opengl/*.cpp only

 private:
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::render::opengl
