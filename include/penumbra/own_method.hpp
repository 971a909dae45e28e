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

/// Shadow methods of the calling program: once added, they are named, rendered and compared as any other.
namespace penumbra {

using Float3 = std::array<float, 3>;  ///< x, y, z

/// The triangles, in the numbers that every method decides visibility by: float32 of (world − origin). Spans are valid
/// until the method is given another scene.
struct MethodScene {
  std::array<double, 3> origin{};
  std::span<const Float3> positions;
  /// Three indices each, in the order of Picture::ids. The order of the three is by position, not the file's: which
  /// side is the front is not in them.
  std::span<const std::array<std::uint32_t, 3>> triangles;
  /// For each triangle, 0: it casts no shadow of this light (it has no area, its mesh casts none, or light passes it).
  std::span<const std::uint8_t> casts;
  Float3 lower{}, upper{};  ///< bounding box of the positions
};

/// One area light, relative to MethodScene::origin. Spans are valid until the method is given another light.
struct MethodLight {
  std::string name;
  std::string kind;  ///< rectangle, disk, ellipse, polygon, sphere or sun
  /// Flat lights: the points center + s·u + t·v, with |s|, |t| <= 1 for a rectangle and s² + t² <= 1 for a disk or
  /// ellipse; u × v points to where the light is emitted. A sun: the directions toward it, in the same form, of which
  /// `center` has unit length. A sphere: its center; u and v are 0.
  Vector center{}, u{}, v{};
  double radius = 0;                 ///< of a disk or sphere
  bool two_sided = false;            ///< emits to both sides
  std::span<const Float3> outline;   ///< flat lights: corners of a convex polygon that holds the light
  std::span<const Float3> points;    ///< light samples; a sun's: directions toward it. A sphere's: see points_for
  std::span<const double> weights;   ///< of each light sample, adding up to 1; empty: all weigh the same
  std::uint32_t light_samples = 0;   ///< how many there are
  std::uint32_t words_per_mask = 0;  ///< ceil(light_samples / 32)
  /// Writes the light samples as point p has them: `points`, or those on the disk of a sphere that p sees.
  std::function<void(const Float3& p, std::span<Float3> points)> points_for;
};

/// The view samples, which say what each pixel sees, row by row from the top left. Spans are valid until the method is
/// given another view.
struct MethodView {
  static constexpr std::int32_t kBackground = -1;

  std::uint32_t width = 0, height = 0;
  std::span<const Float3> p;               ///< relative to MethodScene::origin; 0 in the background
  std::span<const Float3> n;               ///< unit geometric normal toward the camera; 0 in the background
  std::span<const float> depth;            ///< along the camera's axis; 0 in the background
  std::span<const std::int32_t> triangle;  ///< that carries the view sample, or kBackground
};

/// Computes the visibility of a light at view samples. The caller gives a scene, then a light, then a view, each as
/// often as it likes, then asks; it asks one method from one thread at a time, and methods on different threads do not
/// meet. What a function throws ends the renderer's or comparison's call with that exception.
class PENUMBRA_API OwnMethod {
 public:
  OwnMethod() = default;
  OwnMethod(const OwnMethod&) = delete;
  OwnMethod& operator=(const OwnMethod&) = delete;
  virtual ~OwnMethod();

  virtual void set_scene(const MethodScene& scene) = 0;
  virtual void set_light(const MethodLight& light) = 0;
  virtual void set_view(const MethodView& view) = 0;

  /// OwnMethodInfo::masks is false: writes V, from 0 to 1, of each pixel. `pixels`: indices into the view's spans, of
  /// surfaces that receive shadow of this light; the others are answered by the definition. NaN or a number out of
  /// range fails the call.
  virtual void visibility(std::span<const std::uint32_t> pixels, std::span<float> visibility);
  /// OwnMethodInfo::masks is true: sets, of words_per_mask words a pixel, which are 0, bit j mod 32 of word j / 32 if
  /// light sample j is visible.
  virtual void masks(std::span<const std::uint32_t> pixels, std::span<std::uint32_t> masks);
};

/// What there is to know of a method of the calling program.
struct OwnMethodInfo {
  std::string name;              ///< letters, digits, - and _
  std::string family = "image";  ///< or geometry: the group that a comparison finds it in
  std::string paper = {};        ///< what it follows
  std::string exact_for = "nothing";
  bool masks = false;  ///< answers with a bit for each light sample, not with V alone
  /// Kinds of lights that it does.
  std::vector<std::string> lights = {"rectangle", "disk", "ellipse", "polygon", "sphere", "sun"};
  bool textures = false;  ///< weighs V by a light's texture (MethodLight::weights); with masks the caller does
  std::vector<MethodOption> options = {};
};

/// Makes a method with these values of its options, all of them: those not given have their default.
using MakeOwnMethod = std::function<std::unique_ptr<OwnMethod>(const std::map<std::string, std::string>& options)>;

/// Adds a method to those of this process, for its life: methods() lists it, Renderer::render() and compare_json() do
/// it by name, and comparisons of its family (`image`, `geometry`, `all`) have it; no light gets it by default. `make`
/// is called for each renderer and entry, by any thread.
/// Throws UsageError for a name that is taken or malformed, a kind of light or a family that does not exist, or an
/// option whose default it cannot have. Threads may add methods while others render.
PENUMBRA_API void add_method(const OwnMethodInfo& info, MakeOwnMethod make);

}  // namespace penumbra
