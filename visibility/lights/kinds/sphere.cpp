// SPDX-License-Identifier: Apache-2.0
// Spheres: each p sees a different disk (light_frame_from), so that no points are stored. Spheres with a cone are spot
// lamps.

#include "visibility/lights/kinds/light_kinds.hpp"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

namespace penumbra::visibility {
namespace {

void make_sphere(const scenes::LightShape& shape, const LightBuilder& to) {
  const auto& [center, radius, cone] = std::get<scenes::Sphere>(shape);
  Light& light = to.light;
  light.radius = radius;
  if (!(radius > 0)) to.refuse_zero_area(" (its radius is not positive)");
  light.area = std::numbers::pi * radius * radius;
  light.center = light.center_u = light.center_v = to.stored(center);
  if (!is_finite_point(to.stored(center + radius)) || !is_finite_point(to.stored(center - radius))) {
    light.center.x = std::numeric_limits<float>::infinity();  // refused by make_light
  }
  for (const glm::dvec2& sample : to.unit) light.coordinates.push_back(concentric_disk(sample));
  if (!cone) return;
  const double inner = std::cos(glm::radians(cone->inner)), outer = std::cos(glm::radians(cone->outer));
  const double scale = 1 / std::max(0.001, inner - outer);
  light.spot = Light::Spot{glm::normalize(cone->direction), scale, -outer * scale, cone->smooth};
}

}  // namespace

const LightBehaviour kSphereBehaviour{make_sphere, is_round_above_horizon, circle_form_factor};

}  // namespace penumbra::visibility
