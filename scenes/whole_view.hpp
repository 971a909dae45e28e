// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

#include <glm/vec3.hpp>

#include <span>

namespace penumbra::scenes {

/// Lower and upper corner of a bounding box.
struct Bounds {
  glm::dvec3 low, high;
  [[nodiscard]] glm::dvec3 middle() const { return (low + high) / 2.0; }
  /// Returns the radius of the sphere around the box; 1 for a point, so that camera and light are at a distance.
  [[nodiscard]] double radius() const;
};
/// Returns the bounds of at least one position.
Bounds bounds_of(std::span<const glm::dvec3> positions);

/// Returns a camera of 45 degrees, along the picture's height, whose picture contains the sphere around the bounds,
/// seen from the front, right and above; named "synthesised". `aspect`: the picture's width over its height.
Camera camera_that_sees_all(const Bounds& bounds, double aspect = 1);

}  // namespace penumbra::scenes
