// SPDX-License-Identifier: Apache-2.0
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
  /// Vulkan device: a part of its name, its index, or "cpu" for a software device. Empty: the best. Opened when a
  /// method needs a device.
  std::string device = {};
  /// Receives each message of a call, on the calling thread. Empty: messages are dropped.
  std::function<void(LogLevel, std::string_view)> log = {};
  /// Receives the name of the stage and its completed fraction, on the calling thread, several times a second; less
  /// often where a method evaluates many view samples at once (with several view samples a pixel, and for timed methods
  /// of comparisons). The call ends with Cancelled if this function returns false.
  std::function<bool(std::string_view stage, double done)> progress = {};
};

struct RenderOptions {
  std::uint32_t width = 0, height = 0;  ///< in pixels; 0: the scene's size
  /// Name from methods(), optionally with options: "pcss:size=512". Empty: for each light the best method that computes
  /// its exact area; if light samples are given, or no method computes the area, the best geometry-based method, else
  /// rays.
  std::string method = {};
  std::map<std::string, std::string> options = {};  ///< of the method
  /// Number of points on each light, 1 to 4096; 0: exact areas if a method computes them, else 256.
  std::uint32_t light_samples = 0;
  std::string sample_pattern = {};       ///< rows (default), grid, sobol, jittered or rgss
  std::uint32_t sample_seed = 0;         ///< for sobol and jittered
  std::vector<std::string> lights = {};  ///< only these lights, in this order; empty: all
  std::string camera = {};               ///< empty: the camera set last, else the first
  std::uint32_t pixel_samples = 1;       ///< view samples of a pixel, a square number; 1: pixels' centres
  /// For exact areas with several view samples a pixel: V is interpolated between neighbouring pixels where the
  /// estimated error is at most this; 0: every view sample is evaluated.
  double pixel_tolerance = 1.0 / 512;
  /// A light is left out of view samples where, without any occluder, its light would be at most this share of that of
  /// all lights together, in each of red, green and blue; its V is 0 there. 0: no light is left out.
  double light_cutoff = 0;
  bool shading_normals = true;  ///< for the beauty: use vertices' normals where present
  bool masks = true;            ///< keep Picture::masks of methods with masks
  /// How instances are rendered: "copies", "shared" (without copies), or "auto" (also if empty): shared if copies would
  /// exceed 500000 triangles and the method depends only on what lies between a view sample and the light. All three
  /// give the same numbers.
  std::string instances = {};
};

/// Thrown if the calling program's progress function ended a call.
class PENUMBRA_API Cancelled : public Error {
 public:
  Cancelled();
  Cancelled(const Cancelled&) noexcept = default;
  Cancelled& operator=(const Cancelled&) noexcept = default;
  ~Cancelled() override;
};

/// Renders pictures of one scene, and keeps unchanged data from call to call. Hierarchies over a mesh are kept until it
/// moves, and are then refitted; trees over meshes with instances are kept also when instances move. View samples are
/// kept while camera, size and meshes are unchanged, the Vulkan device always. Renderers on different threads are
/// independent; one renderer is for one thread at a time. A call that throws leaves the renderer usable. A renderer
/// that was moved from can only be destroyed or assigned to.
class PENUMBRA_API Renderer {
 public:
  explicit Renderer(Scene scene, RendererOptions options = {});
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;
  ~Renderer();

  /// Returns the scene of the next call, for any changes. Throws UsageError during a call.
  [[nodiscard]] Scene& scene();
  [[nodiscard]] const Scene& scene() const;

  /// Renders the scene and returns the same numbers as written by `penumbra render`. Throws UsageError for invalid
  /// options, InputError for a scene that cannot be rendered at all or by this method, ResourceError, and Cancelled.
  Picture render(const RenderOptions& options = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra
