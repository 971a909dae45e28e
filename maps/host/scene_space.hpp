// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace penumbra::maps {

/// Relation of the space in which maps are made to the scene, where the camera is: `to_scene` maps (p, 1) to (x w, w),
/// with x the point in the scene and w > 0 for everything that is lit. A homography maps planes to planes, so the
/// frustum, slices of depth and moves along surfaces can be computed in the maps' space. By default both spaces are the
/// same, and all results are exactly those without this class.
class SceneSpace {
 public:
  SceneSpace() = default;
  explicit SceneSpace(const glm::dmat4& to_scene) : to_scene_(to_scene), from_scene_(glm::inverse(to_scene)) {}

  [[nodiscard]] glm::dvec3 scene_point(const glm::dvec3& p) const {
    const glm::dvec4 at = to_scene_ * glm::dvec4(p, 1);
    return glm::dvec3(at) / at.w;
  }
  /// Converts a plane of the scene: returns (n, c) such that n · p + c is w times the value of the given plane at the
  /// scene's point for p. Both values have the same sign.
  [[nodiscard]] glm::dvec4 plane(const glm::dvec4& in_scene) const { return glm::transpose(to_scene_) * in_scene; }
  /// Returns (n, c) such that n · p + c is w at p.
  [[nodiscard]] glm::dvec4 divisor() const { return plane({0, 0, 0, 1}); }
  /// Returns the scene's normal, of any length, of the plane that goes through p with the normal n in the maps' space.
  [[nodiscard]] glm::dvec3 scene_normal(const glm::dvec3& p, const glm::dvec3& n) const {
    return glm::dvec3(glm::transpose(from_scene_) * glm::dvec4(n, -glm::dot(n, p)));
  }
  /// Returns how p moves when its point x in the scene moves by `by`.
  [[nodiscard]] glm::dvec3 moves(const glm::dvec3& p, const glm::dvec3& by) const {
    const glm::dvec4 at = from_scene_ * glm::dvec4(scene_point(p), 1), change = from_scene_ * glm::dvec4(by, 0);
    return (glm::dvec3(change) - p * change.w) / at.w;
  }

 private:
  glm::dmat4 to_scene_{1}, from_scene_{1};
};

/// Method whose maps depend on the camera.
class SeesScene {
 public:
  SeesScene() = default;
  SeesScene(const SeesScene&) = delete;
  SeesScene& operator=(const SeesScene&) = delete;
  virtual ~SeesScene() = default;

  /// Sets the space that relates maps to the camera of the next view samples. Called before prepare_light.
  virtual void see_through(const SceneSpace& space) = 0;
};

}  // namespace penumbra::maps
