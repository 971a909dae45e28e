// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/scene_space.hpp"
#include "visibility/all_triangles.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec3.hpp>

#include <functional>
#include <span>

namespace penumbra::maps {

/// Scene under a sun, transformed by the projective map that moves the sun to a finite distance. With X, Y across the
/// sun's axis and Z along the axis, in the direction of light,
///   x = S X / q,  y = S Y / q,  z = S² / q,  q = b − Z > 0
/// maps lines to lines, and the points at infinity in the sun's directions to a disk in the plane z = 0, whose radius
/// is S times the tangent of half the sun's angle. So V of the disk over the mapped scene is V of the sun. The
/// perspective window of the disk's centre, x / z = X / S, is the orthographic window along the sun's axis, and the
/// widths of penumbrae, (z_r − z_o) / z_o times the light, are tangent times distance. b is so far below the scene that
/// the map is close to a translation: lengths change by up to 12 %, so that biases and mean depths have nearly the same
/// meaning as elsewhere.
class SunSpace final : public visibility::AllTriangles {
 public:
  /// `sun` must be a sun. `all`: all triangles, if the scene has only some of them, else null. Arguments must outlive
  /// this object.
  SunSpace(const visibility::SceneFloats& scene, const visibility::Light& sun,
           const visibility::AllTriangles* all = nullptr);

  /// Changes to another sun with the same direction, of any angle and radiance, and keeps the scene. Returns false if
  /// the direction differs.
  bool take(const visibility::Light& sun);

  [[nodiscard]] const visibility::SceneFloats& scene() const { return scene_; }
  /// Calls take(run) for all triangles, mapped, if the constructor was given any.
  void for_each_run(const std::function<void(const Run&)>& take) const override;
  void for_each_positions(const std::function<void(std::span<const glm::vec3>)>& take) const override;
  /// Returns the disk. A sun of one direction is replaced by a disk with a tangent of 2⁻²⁰, less than a texel of any
  /// map.
  [[nodiscard]] const visibility::Light& light() const { return light_; }
  /// Returns the relation of this space to the scene, where the camera of the view samples is.
  [[nodiscard]] SceneSpace space() const;
  /// Returns view samples of the original scene, mapped to this space.
  [[nodiscard]] visibility::ViewSamples mapped(const visibility::ViewSamples& samples) const;

 private:
  /// Returns coordinates along X, Y, Z, relative to the scene's middle.
  [[nodiscard]] glm::dvec3 local(const glm::vec3& p) const;
  [[nodiscard]] glm::vec3 mapped(const glm::vec3& p) const;

  void make_light(const visibility::Light& sun);

  visibility::Light::Directions directions_;  // directions of the sun that defines the axes
  glm::dvec3 u_{0}, v_{0}, n_{0}, middle_{0};
  double scale_ = 1, below_ = 1;  // S, and b from the scene's middle
  visibility::SceneFloats scene_;
  const visibility::AllTriangles* all_ = nullptr;
  visibility::Light light_;
};

}  // namespace penumbra::maps
