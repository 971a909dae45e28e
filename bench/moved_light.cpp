// SPDX-License-Identifier: Apache-2.0
// Moves a light by a twelfth of its width.

#include "bench/moved_light.hpp"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <stdexcept>

namespace penumbra::bench {
namespace {

constexpr double kShare = 1.0 / 12;  // of the light's width

/// Returns a perpendicular vector of unit length.
glm::dvec3 perpendicular_to(const glm::dvec3& direction) {
  const glm::dvec3 other =
      std::abs(direction.x) < 0.5 * glm::length(direction) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return glm::normalize(glm::cross(direction, other));
}

struct Mover {
  scenes::LightShape operator()(scenes::Rectangle light) const {
    light.center += 2 * kShare * light.half_u;
    return light;
  }
  scenes::LightShape operator()(scenes::Ellipse light) const {
    light.center += 2 * kShare * light.half_u;
    return light;
  }
  scenes::LightShape operator()(scenes::Disk light) const {
    light.center += 2 * kShare * light.radius * perpendicular_to(light.normal);
    return light;
  }
  scenes::LightShape operator()(scenes::Sphere light) const {
    light.center.x += 2 * kShare * light.radius;
    return light;
  }
  scenes::LightShape operator()(scenes::Polygon light) const {
    const glm::dvec3 toward = kShare * (light.vertices.at(1) - light.vertices.at(0));
    for (glm::dvec3& vertex : light.vertices) vertex += toward;
    return light;
  }
  scenes::LightShape operator()(scenes::Sun light) const {
    const double turn = kShare * glm::radians(light.angle > 0 ? light.angle : 0.5);
    light.direction =
        glm::normalize(std::cos(turn) * light.direction + std::sin(turn) * perpendicular_to(light.direction));
    return light;
  }
  scenes::LightShape operator()(scenes::Dome light) const {
    light.rotate += 360 * kShare;
    return light;
  }
  scenes::LightShape operator()(const scenes::Pieces& /*light*/) const {
    throw std::logic_error("a light in pieces is not moved");
  }
};

}  // namespace

scenes::LightShape moved_light(const scenes::LightShape& shape) {
  return std::visit(Mover(), shape);
}

}  // namespace penumbra::bench
