// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace penumbra::maps {

/// Where the camera is for maps that are made in a space of their own: `to_scene` takes (p, 1) there to (x w, w), x in
/// the scene and w > 0 at all that is lit. A homography takes planes to planes, so that the frustum, slices of depth
/// and moves along surfaces can be had there. By default the space is the scene's own, and all of these are exactly
/// what they are without it.
class SceneSpace {
 public:
  SceneSpace() = default;
  explicit SceneSpace(const glm::dmat4& to_scene) : to_scene_(to_scene), from_scene_(glm::inverse(to_scene)) {}

  [[nodiscard]] glm::dvec3 scene_point(const glm::dvec3& p) const {
    const glm::dvec4 at = to_scene_ * glm::dvec4(p, 1);
    return glm::dvec3(at) / at.w;
  }
  /// Returns (n, c) of the plane n · p + c, which has the sign of the scene's (n, c) at its point x, and w times its
  /// value.
  [[nodiscard]] glm::dvec4 plane(const glm::dvec4& in_scene) const { return glm::transpose(to_scene_) * in_scene; }
  /// Returns (n, c) of the function n · p + c that is w at p.
  [[nodiscard]] glm::dvec4 divisor() const { return plane({0, 0, 0, 1}); }
  /// Returns a normal in the scene, of any length, of the plane through p with the normal n here.
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

  /// Announces where the camera of the next view samples is. Called before prepare_light.
  virtual void see_through(const SceneSpace& space) = 0;
};

}  // namespace penumbra::maps
