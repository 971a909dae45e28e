// SPDX-License-Identifier: Apache-2.0
// Places a camera so that a bounding sphere fits its picture.

#include "scenes/whole_view.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra::scenes {

double Bounds::radius() const {
  const double radius = glm::distance(low, high) / 2;
  return radius > 0 ? radius : 1;
}

Bounds bounds_of(std::span<const glm::dvec3> positions) {
  Bounds bounds{positions.front(), positions.front()};
  for (const glm::dvec3& p : positions) {
    bounds.low = glm::min(bounds.low, p);
    bounds.high = glm::max(bounds.high, p);
  }
  return bounds;
}

Camera camera_that_sees_all(const Bounds& bounds, double aspect) {
  Camera camera;
  camera.name = "synthesised";
  camera.target = bounds.middle();
  const double half_height = std::tan(glm::radians(camera.vertical_fov) / 2);
  const double distance = bounds.radius() / std::sin(std::atan(half_height * std::min(aspect, 1.0)));
  camera.eye = camera.target + distance * glm::normalize(glm::dvec3(0.5, 0.5, 1));
  return camera;
}

}  // namespace penumbra::scenes
