#pragma once

#include "scenes/scene.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::visibility {

/// What a pixel's centre looks along: start + t · direction, t > 0.
struct ViewRay {
  glm::dvec3 start, direction;
};

/// A camera relative to the scene's origin, in double. The ray of pixel (x, y), y down, is
/// eye + t · (middle + ((2(x + ½)/W − 1) · aspect · right + (1 − 2(y + ½)/H) · up) · tan(fov/2)). All but `middle` are
/// unit vectors, at right angles; that is the ray through the picture's middle, middle · forward = 1, and `forward`
/// itself unless the lens is shifted: t is the distance along the view axis. Orthographic: (eye + ((2(x + ½)/W − 1) ·
/// aspect · right + (1 − 2(y + ½)/H) · up) · half_height) + t · forward; there a shift has moved the eye.
struct PinholeCamera {
  glm::dvec3 eye{0}, right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1}, middle{0, 0, -1};
  double tan_half_fov = 1;
  std::optional<double> half_height = {};  ///< of an orthographic camera, in place of the field of view
  std::uint32_t width = 0, height = 0;

  /// The factors of `right` and `up` in a ray, before the one of the field of view.
  [[nodiscard]] double across(std::uint32_t x) const;
  [[nodiscard]] double upward(std::uint32_t y) const;
  /// Of a perspective camera.
  [[nodiscard]] glm::dvec3 direction(std::uint32_t x, std::uint32_t y) const;
  [[nodiscard]] ViewRay ray(std::uint32_t x, std::uint32_t y) const;

  /// What a direction's product with is its place across (up) the picture, from −1 to 1, times its depth. Of a
  /// perspective camera.
  [[nodiscard]] glm::dvec3 screen_across() const;
  [[nodiscard]] glm::dvec3 screen_upward() const;

  bool operator==(const PinholeCamera&) const = default;
};

/// Throws InputError when eye and target coincide or `up` is parallel to the view direction.
PinholeCamera make_camera(const scenes::Camera& camera, const glm::dvec3& origin, std::uint32_t width,
                          std::uint32_t height);

/// What each pixel sees, in scan-line order: carrying triangle, p, geometric normal toward the viewer.
struct ViewSamples {
  static constexpr std::int32_t kBackground = -1;

  std::uint32_t width = 0, height = 0;
  std::vector<std::int32_t> triangle;  ///< carrying triangle (index into SceneFloats::triangles), or kBackground
  std::vector<glm::vec3> p;            ///< relative to the origin, rounded once from double; 0 for background
  std::vector<glm::vec3> n;            ///< unit geometric normal turned toward the viewer; 0 for background
  std::vector<float> depth;            ///< along the view axis; 0 for background
  std::vector<std::int8_t> facing;  ///< +1: the sorted triangle's (b − a) × (c − a) points to the viewer's side, −1:
                                    ///< away; 0 for background. The one answer to "which side is the viewer on"
  PinholeCamera camera;  ///< that they were seen by
  glm::vec3 eye{0};      ///< float32 of the camera's eye (for display; decisions take `facing`)

  [[nodiscard]] std::size_t size() const { return triangle.size(); }
};

/// Does the pixel's ray meet the closed triangle (sorted vertices) beyond its start, and at which t?
/// Double arithmetic on the scene floats; each edge's sign is computed from its end points in lexicographic order, so
/// two triangles that share an edge never leave a crack. Triangles of zero area or seen edge-on cover nothing.
std::optional<double> cover(const ViewRay& ray, const std::array<glm::vec3, 3>& corners);

/// Is there something of the triangle's surface where the ray meets its plane? Not where a surface with holes has one,
/// and nothing translucent: such surfaces carry no view sample (docs/definitions.md).
bool may_carry(const SceneFloats& scene, std::uint32_t triangle, const ViewRay& ray);

/// Fills p, n and depth from the carrying triangle of each pixel (kBackground where there is none). The definition:
/// intersection of the pixel's ray with the triangle's plane in double from its sorted vertices; p rounded once.
ViewSamples complete_view_samples(const SceneFloats& scene, const PinholeCamera& camera,
                                  std::vector<std::int32_t> triangles);

/// The triangle that carries a pixel's view sample, by definition: tries all. kBackground where there is none.
std::int32_t carrier_of(const SceneFloats& scene, const PinholeCamera& camera, std::uint32_t x, std::uint32_t y);

/// The C++ twin of the visibility buffer: tries every triangle at every pixel. Slow; the truth in tests.
ViewSamples brute_force_view_samples(const SceneFloats& scene, const PinholeCamera& camera);

/// What kind of receiver a pixel is for one light.
enum class PixelClass : std::uint8_t {
  background,  ///< A = 0
  emitter,     ///< carries the light's own body: V = 1
  unshadowed,  ///< receivesShadow is false: V = 1
  judged,      ///< the whole light is above the tangent plane and p is in front of the light
  horizon,     ///< some of the light is not strictly above the tangent plane
  behind,      ///< p is not strictly on an emitting side of the light
  unlit,       ///< the carrier's object is not among those that the light lights: V = 0
  other_body,  ///< p, in front of the light, is on the body of another one: V as anywhere, but errors leave it out
};

/// Exact (the predicates of pair_truth on the stored floats; the light by its outline). One entry a pixel.
std::vector<PixelClass> classify_pixels(const SceneFloats& scene, const ViewSamples& samples, const Light& light);

}  // namespace penumbra::visibility
