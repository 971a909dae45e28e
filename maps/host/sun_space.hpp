#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec3.hpp>

namespace penumbra::maps {

/// A scene under a sun, seen through the projective map that brings the sun into its neighbourhood. With X, Y across
/// the sun's axis and Z along it, the way light travels,
///     x = S X / q,  y = S Y / q,  z = S² / q,  q = b − Z > 0
/// takes lines to lines, and the points at infinity that are the sun's directions to a disk in the plane z = 0: its
/// radius is S times the tangent of half the sun's angle. So V of the disk over the mapped scene is V of the sun. The
/// perspective window of the disk's centre, x / z = X / S, is the orthographic window along the sun's axis, and the
/// widths of penumbrae, (z_r − z_o) / z_o times the light, are tangent times distance. b is so far below the scene that
/// the map is close to a shift: lengths change by up to 12 %, so that biases and mean depths mean there what they mean
/// elsewhere.
class SunSpace {
 public:
  /// `sun` must be one.
  SunSpace(const visibility::SceneFloats& scene, const visibility::Light& sun);

  /// Another sun that shines the same way, whatever its angle and radiance: the scene stays. False if it does not.
  bool take(const visibility::Light& sun);

  [[nodiscard]] const visibility::SceneFloats& scene() const { return scene_; }
  /// The disk. A sun of one direction is one of 2⁻²⁰, less than a texel of any map.
  [[nodiscard]] const visibility::Light& light() const { return light_; }
  /// View samples of the scene that it was made of.
  [[nodiscard]] visibility::ViewSamples mapped(const visibility::ViewSamples& samples) const;

 private:
  /// In the axes X, Y, Z, from the scene's middle.
  [[nodiscard]] glm::dvec3 local(const glm::vec3& p) const;
  [[nodiscard]] glm::vec3 mapped(const glm::vec3& p) const;

  void make_light(const visibility::Light& sun);

  visibility::Light::Directions way_;  // whose axes these are
  glm::dvec3 u_{0}, v_{0}, n_{0}, middle_{0};
  double scale_ = 1, below_ = 1;  // S, and b from the scene's middle
  visibility::SceneFloats scene_;
  visibility::Light light_;
};

}  // namespace penumbra::maps
