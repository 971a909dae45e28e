// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"
#include "visibility/lens.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::visibility {

/// The ray through a pixel's centre: start + t · direction, t > 0.
struct ViewRay {
  glm::dvec3 start, direction;
};

/// A camera relative to the scene's origin, in double. The ray of pixel (x, y), y down, is
/// eye + t · (middle + ((2(x + ½)/W − 1) · aspect · right + (1 − 2(y + ½)/H) · up) · tan(fov/2)). All but `middle` are
/// orthogonal unit vectors. `middle` is the direction of the ray through the picture's middle, with middle · forward =
/// 1; it is `forward` itself unless the lens is shifted. So t is the distance along the view axis. Orthographic: (eye +
/// ((2(x + ½)/W − 1) · aspect · right + (1 − 2(y + ½)/H) · up) · half_height) + t · forward; a shift has then moved the
/// eye. With a lens the ray begins at the lens's point for that pixel, and meets the ray of a camera without a lens at
/// the focus distance; t is still the distance along the view axis. A camera may cover only some rows of its picture: y
/// then counts from `first_row`, H is the whole picture's height, and each ray has the same bits as for the whole
/// picture.
struct PinholeCamera {
  glm::dvec3 eye{0}, right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1}, middle{0, 0, -1};
  double tan_half_fov = 1;
  std::optional<double> half_height = {};  ///< of an orthographic camera, in place of the field of view
  std::uint32_t width = 0, height = 0;
  std::uint32_t first_row = 0, rows_of_picture = 0;  ///< rows_of_picture 0: `height`, the whole picture
  std::optional<Lens> lens = {};                     ///< nullopt: a pinhole

  /// Returns H, the height of the whole picture.
  [[nodiscard]] std::uint32_t picture_height() const { return rows_of_picture != 0 ? rows_of_picture : height; }

  /// Return the factors of `right` and `up` in a ray, without that of the field of view.
  [[nodiscard]] double across(std::uint32_t x) const;
  [[nodiscard]] double upward(std::uint32_t y) const;
  /// Returns the direction of a perspective camera's ray from its eye, whatever the lens.
  [[nodiscard]] glm::dvec3 direction(std::uint32_t x, std::uint32_t y) const;
  [[nodiscard]] ViewRay ray(std::uint32_t x, std::uint32_t y) const;

  /// Return a vector whose dot product with a direction is the direction's place across (or up) the whole picture, from
  /// −1 to 1, times its depth. For a perspective camera.
  [[nodiscard]] glm::dvec3 screen_across() const;
  [[nodiscard]] glm::dvec3 screen_upward() const;

  bool operator==(const PinholeCamera&) const = default;
};

/// Makes a camera. Throws InputError when eye and target coincide or `up` is parallel to the view direction.
PinholeCamera make_camera(const scenes::Camera& camera, const glm::dvec3& origin, std::uint32_t width,
                          std::uint32_t height);

/// Visible points of all pixels, in scan-line order: carrying triangle, p, geometric normal toward the viewer.
struct ViewSamples {
  static constexpr std::int32_t kBackground = -1;

  std::uint32_t width = 0, height = 0;
  std::vector<std::int32_t> triangle;  ///< carrying triangle (index into SceneFloats::triangles), or kBackground
  std::vector<glm::vec3> p;            ///< relative to the origin, rounded once from double; 0 for background
  std::vector<glm::vec3> n;            ///< unit geometric normal toward the viewer; 0 for background
  std::vector<float> depth;            ///< along the view axis; 0 for background
  std::vector<std::int8_t> facing;  ///< +1: the sorted triangle's (b − a) × (c − a) points to the viewer's side, −1:
                                    ///< away; 0 for background. The only definition of the viewer's side
  PinholeCamera camera;  ///< the camera that sees them
  glm::vec3 eye{0};      ///< float32 of the camera's eye (for display; decisions use `facing`)

  [[nodiscard]] std::size_t size() const { return triangle.size(); }
};

/// Returns the t at which the pixel's ray meets the closed triangle (sorted vertices) beyond its start; nullopt if it
/// does not. Double arithmetic on the scene floats; each edge's sign is computed from its end points in lexicographic
/// order, so that two triangles with a common edge never leave a gap. Triangles of zero area or seen edge-on cover
/// nothing.
std::optional<double> cover(const ViewRay& ray, const std::array<glm::vec3, 3>& corners);

/// Returns whether the triangle's surface exists where the ray meets its plane. Holes and translucent surfaces carry no
/// view sample (docs/definitions.md).
bool may_carry(const SceneFloats& scene, std::uint32_t triangle, const ViewRay& ray);

/// Fills p, n and depth from the carrying triangle of each pixel (kBackground for none). By definition: intersection of
/// the pixel's ray with the triangle's plane in double from its sorted vertices; p rounded once.
ViewSamples complete_view_samples(const SceneFloats& scene, const PinholeCamera& camera,
                                  std::vector<std::int32_t> triangles);

/// Returns the triangle that carries a pixel's view sample, by definition: tests all. kBackground if there is none.
std::int32_t carrier_of(const SceneFloats& scene, const PinholeCamera& camera, std::uint32_t x, std::uint32_t y);

/// Returns the view samples by testing every triangle at every pixel: the C++ counterpart of the visibility buffer.
/// Slow; the reference in tests.
ViewSamples brute_force_view_samples(const SceneFloats& scene, const PinholeCamera& camera);

/// Kind of receiver that a pixel is for one light.
enum class PixelClass : std::uint8_t {
  background,  ///< no surface: the image's alpha is 0
  emitter,     ///< carries the light's own body: V = 1
  unshadowed,  ///< receivesShadow is false: V = 1
  judged,      ///< the whole light is above the tangent plane and p is in front of the light
  horizon,     ///< some of the light is not strictly above the tangent plane
  behind,      ///< p is not strictly on an emitting side of the light
  unlit,       ///< the carrier's object is not lit by the light: V = 0
  other_body,  ///< p, in front of the light, is on the body of another light: V as usual, but excluded from errors
};

/// Classifies pixels, exactly (the predicates of pair_truth on the stored floats; the light by its outline). One entry
/// for each pixel.
std::vector<PixelClass> classify_pixels(const SceneFloats& scene, const ViewSamples& samples, const Light& light);

}  // namespace penumbra::visibility
