#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

/// A second rasteriser: OpenGL 4.5 (core) on an EGL context without a surface, so that no display is needed. Knows
/// nothing of shadows, and nothing of Vulkan.
namespace penumbra::render::opengl {

/// What OpenGL is on one EGL device, and why it cannot be used if it cannot.
struct ContextInfo {
  std::uint32_t index = 0;
  std::string platform;  ///< how EGL was asked: "device 0", or "surfaceless"
  std::string name;      ///< the renderer's, or the platform's where there is no context
  std::string kind;      ///< "cpu" or "gpu"
  std::string driver;    ///< vendor and version
  std::vector<std::string> refusals;
  std::uint32_t subpixel_bits = 0;  ///< GL_SUBPIXEL_BITS: corners are snapped to 2^-bits of a pixel
  std::uint32_t max_image_size = 0;
  std::uint64_t max_storage_block = 0;

  [[nodiscard]] bool usable() const { return refusals.empty(); }
};

/// What this machine has. One entry that says why where there is nothing: this build was made without OpenGL, there is
/// no EGL driver. Never throws.
std::vector<ContextInfo> list_contexts();

/// A context without a surface. It is made current where it is used, one thread at a time, and on no thread after.
class Context {
 public:
  /// The first that is usable; of several, one on the processor if `on_processor`, else not. Throws ResourceError
  /// with the reason why each was refused.
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
