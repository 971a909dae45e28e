// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/export.hpp>
#include <penumbra/methods.hpp>
#include <penumbra/scene.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// Shadow methods of the calling program. Once added, they are selected by name, rendered and compared like all others.
namespace penumbra {

using Float3 = std::array<float, 3>;  ///< x, y, z

/// Triangles, in the coordinates with which every method decides visibility: float32 of (world − origin). Spans are
/// valid until the method is given another scene.
struct MethodScene {
  std::array<double, 3> origin{};
  std::span<const Float3> positions;
  /// Three vertex indices for each triangle, in the order of Picture::ids. The three are sorted by position, not as in
  /// the file, so that their order does not show the front side.
  std::span<const std::array<std::uint32_t, 3>> triangles;
  /// For each triangle: 0 if it casts no shadow of this light (it has no area, its mesh casts no shadows, or its mesh
  /// is transparent to this light).
  std::span<const std::uint8_t> casts;
  Float3 lower{}, upper{};  ///< bounding box of the positions
};

/// Area light, relative to MethodScene::origin. Spans are valid until the method is given another light.
struct MethodLight {
  std::string name;
  std::string kind;  ///< rectangle, disk, ellipse, polygon, sphere or sun
  /// Flat lights: the points center + s·u + t·v, with |s|, |t| <= 1 for a rectangle and s² + t² <= 1 for a disk or
  /// ellipse; u × v points to the emitting side. A sun: the directions toward the sun, in the same form, with `center`
  /// of unit length. A sphere: its center; u and v are 0.
  Vector center{}, u{}, v{};
  double radius = 0;                 ///< of a disk or sphere
  bool two_sided = false;            ///< emits to both sides
  std::span<const Float3> outline;   ///< flat lights: corners of a convex polygon that contains the light
  std::span<const Float3> points;    ///< light samples; for a sun: directions toward the sun. For a sphere: see
                                     ///< points_for
  std::span<const double> weights;   ///< of each light sample, adding up to 1; empty: uniform
  std::uint32_t light_samples = 0;   ///< number of light samples
  std::uint32_t words_per_mask = 0;  ///< ceil(light_samples / 32)
  /// Writes the light samples for the point p: `points`, or those on the disk of a sphere visible from p.
  std::function<void(const Float3& p, std::span<Float3> points)> points_for;
};

/// View samples: the surface point at each pixel, row by row from the top left. Spans are valid until the method is
/// given another view.
struct MethodView {
  static constexpr std::int32_t kBackground = -1;

  std::uint32_t width = 0, height = 0;
  std::span<const Float3> p;               ///< relative to MethodScene::origin; 0 in the background
  std::span<const Float3> n;               ///< unit geometric normal toward the camera; 0 in the background
  std::span<const float> depth;            ///< along the camera's axis; 0 in the background
  std::span<const std::int32_t> triangle;  ///< triangle of the view sample, or kBackground
};

/// Computes the visibility of a light at view samples. The caller sets a scene, then a light, then a view, each any
/// number of times, then calls visibility() or masks(). One method is called from one thread at a time, and methods on
/// different threads are independent. An exception thrown by a member function ends the renderer's or comparison's
/// call.
class PENUMBRA_API OwnMethod {
 public:
  OwnMethod() = default;
  OwnMethod(const OwnMethod&) = delete;
  OwnMethod& operator=(const OwnMethod&) = delete;
  virtual ~OwnMethod();

  virtual void set_scene(const MethodScene& scene) = 0;
  virtual void set_light(const MethodLight& light) = 0;
  virtual void set_view(const MethodView& view) = 0;

  /// Called if OwnMethodInfo::masks is false: writes V, from 0 to 1, of each pixel. `pixels`: indices into the view's
  /// spans of the pixels whose surfaces receive shadows of this light; no other pixel needs the method. NaN or a number
  /// out of range fails the call.
  virtual void visibility(std::span<const std::uint32_t> pixels, std::span<float> visibility);
  /// Called if OwnMethodInfo::masks is true: sets bit j mod 32 of word j / 32 if light sample j is visible. `masks` has
  /// words_per_mask words for each of `pixels`, initialised to 0.
  virtual void masks(std::span<const std::uint32_t> pixels, std::span<std::uint32_t> masks);
};

/// Description of a method of the calling program.
struct OwnMethodInfo {
  std::string name;              ///< letters, digits, - and _
  std::string family = "image";  ///< image or geometry: the method's group in comparisons
  std::string paper = {};        ///< publication of the method
  std::string exact_for = "nothing";
  bool masks = false;  ///< computes one bit for each light sample, not V alone
  /// Supported kinds of lights.
  std::vector<std::string> lights = {"rectangle", "disk", "ellipse", "polygon", "sphere", "sun"};
  bool textures = false;  ///< weights V by a light's texture (MethodLight::weights); with masks the caller applies the
                          ///< weights
  std::vector<MethodOption> options = {};
};

/// Makes a method with the given values of all its options; options not set by the user have their default.
using MakeOwnMethod = std::function<std::unique_ptr<OwnMethod>(const std::map<std::string, std::string>& options)>;

/// Adds a method for the lifetime of the process: methods() lists it, Renderer::render() and compare_json() accept its
/// name, and comparisons of its family (`image`, `geometry`, `all`) include it; it is never the default of a light.
/// `make` is called for each renderer and entry, by any thread. Throws UsageError for a name that is taken or
/// malformed, an unknown kind of light or family, or an option with an invalid default. Thread-safe: methods may be
/// added while other threads render.
PENUMBRA_API void add_method(const OwnMethodInfo& info, MakeOwnMethod make);

}  // namespace penumbra
