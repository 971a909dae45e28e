#pragma once

#include "scenes/scene.hpp"

#include <glm/vec3.hpp>

#include <span>

namespace penumbra::scenes {

/// The corners of the box around points.
struct Bounds {
  glm::dvec3 low, high;
  [[nodiscard]] glm::dvec3 middle() const { return (low + high) / 2.0; }
  /// Of the sphere around the box; of a point 1, so that a camera and a light have room.
  [[nodiscard]] double radius() const;
};
/// At least one position.
Bounds bounds_of(std::span<const glm::dvec3> positions);

/// A camera of 45 degrees, along the picture's height, that has the sphere around the bounds in its picture, seen from
/// its front, right and above; named "synthesised". `aspect`: the picture's width over its height.
Camera camera_that_sees_all(const Bounds& bounds, double aspect = 1);

}  // namespace penumbra::scenes
