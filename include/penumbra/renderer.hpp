#pragma once

#include <penumbra/error.hpp>
#include <penumbra/export.hpp>
#include <penumbra/picture.hpp>
#include <penumbra/scene.hpp>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

enum class LogLevel : std::uint8_t { debug, info, warning, error };

struct RendererOptions {
  /// The Vulkan device: a part of its name, its index, or "cpu" for one that the processor plays. Empty: the best. It
  /// is made when a method needs one.
  std::string device = {};
  /// Gets each message of a call, on the calling thread. Empty: nobody does.
  std::function<void(LogLevel, std::string_view)> log = {};
  /// Gets the name of the stage and the done share of it, on the calling thread, many times a second. The call ends
  /// with Cancelled if it returns false.
  std::function<bool(std::string_view stage, double done)> progress = {};
};

struct RenderOptions {
  std::uint32_t width = 0, height = 0;  ///< pixels; 0: the scene's
  /// A name of methods(), perhaps with options: "pcss:size=512". Empty: for each light the best that gives its exact
  /// area; where light samples are asked for, or no method gives it, the best geometry-based one, else rays.
  std::string method = {};
  std::map<std::string, std::string> options = {};  ///< of the method
  /// Points on each light, 1 to 4096; 0: exact areas where a method has them, else 256.
  std::uint32_t light_samples = 0;
  std::string sample_pattern = {};       ///< rows (default), grid, sobol, jittered or rgss
  std::uint32_t sample_seed = 0;         ///< of sobol and jittered
  std::vector<std::string> lights = {};  ///< these alone, in this order; empty: all
  std::string camera = {};               ///< empty: the one that was set last, else the first
  std::uint32_t pixel_samples = 1;       ///< view samples a pixel, a square number; 1: pixels' centres
  /// Of exact areas at several view samples a pixel: V is interpolated between neighbouring pixels where the error that
  /// is estimated of it is at most this; 0: every view sample is evaluated.
  double pixel_tolerance = 1.0 / 512;
  bool shading_normals = true;  ///< of beauty: vertices' normals where there are any
  bool masks = true;            ///< keep Picture::masks of methods that have some
};

/// The calling program's progress function asked for the end of a call.
class PENUMBRA_API Cancelled : public Error {
 public:
  Cancelled();
  Cancelled(const Cancelled&) noexcept = default;
  Cancelled& operator=(const Cancelled&) noexcept = default;
  ~Cancelled() override;
};

/// Renders pictures of one scene, and keeps from call to call what did not change: hierarchies over a mesh while it
/// stays where it is (and refits them when it moves), view samples while camera, size and meshes stay, the Vulkan
/// device always. Renderers on different threads do not meet; one renderer is for one thread at a time. A call that
/// throws leaves the renderer usable.
class PENUMBRA_API Renderer {
 public:
  explicit Renderer(Scene scene, RendererOptions options = {});
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;
  ~Renderer();

  /// What the next call renders; change it as you like. Throws UsageError while a call is at work.
  [[nodiscard]] Scene& scene();
  [[nodiscard]] const Scene& scene() const;

  /// The same numbers as `penumbra render` writes. Throws UsageError for options that cannot be meant, InputError for a
  /// scene that cannot be rendered, or not by this method, ResourceError, Cancelled.
  Picture render(const RenderOptions& options = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra
