// SPDX-License-Identifier: Apache-2.0
// Suns: directions around a middle one, the disk at distance 1 whose radius is the tangent of half the angle.

#include "base/error.hpp"
#include "visibility/axes_around.hpp"
#include "visibility/lights/kinds/light_kinds.hpp"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

namespace penumbra::visibility {
namespace {

void make_sun(const scenes::LightShape& shape, const LightBuilder& to) {
  const auto& [direction, angle] = std::get<scenes::Sun>(shape);
  Light& light = to.light;
  const double length = glm::length(direction);
  if (!(length > 0) || !(angle >= 0 && angle < 180)) {
    throw InputError(
        "light \"{}\": a sun needs a direction and an angle from 0 to less than 180 degrees; they are ({}, {}, {}) "
        "and {}",
        light.name, direction.x, direction.y, direction.z, angle);
  }
  const glm::dvec3 travels = direction / length;
  const Axes axes = axes_around(travels);
  const double tangent = std::tan(glm::radians(angle) / 2);
  light.sun = Light::Directions{glm::vec3(axes.u) + 0.0f, glm::vec3(axes.v) + 0.0f, tangent};
  light.area = std::numbers::pi * tangent * tangent;
  light.center = light.center_u = light.center_v = glm::vec3(-travels) + 0.0f;
  if (tangent == 0) light.radiance /= std::numbers::pi;
  for (const glm::dvec2& sample : to.unit) {
    const glm::dvec2 st = concentric_disk(sample);
    light.coordinates.push_back(st);
    light.points.push_back(glm::vec3(-travels + tangent * (st.x * axes.u + st.y * axes.v)) + 0.0f);
  }
}

double sun_form_factor(const UnshadowedLight& seen) {
  if (seen.radius() == 0) return std::max(0.0, glm::dot(seen.normal(), seen.along()));
  return circle_form_factor(seen);
}

}  // namespace

const LightBehaviour kSunBehaviour{make_sun, is_round_above_horizon, sun_form_factor};

}  // namespace penumbra::visibility
