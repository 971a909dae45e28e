// SPDX-License-Identifier: Apache-2.0
// Ellipses: the unit disk of any frame.

#include "visibility/lights/form_factor.hpp"
#include "visibility/lights/kinds/light_kinds.hpp"

#include <glm/geometric.hpp>

#include <numbers>
#include <variant>

namespace penumbra::visibility {
namespace {

void make_ellipse(const scenes::LightShape& shape, const LightBuilder& to) {
  const auto& [center, u, v] = std::get<scenes::Ellipse>(shape);
  to.light.area = std::numbers::pi * glm::length(glm::cross(u, v));
  if (!(to.light.area > 0)) to.refuse_zero_area(" (halfU and halfV are parallel or zero)");
  to.add_round(center, u, v);
}

double ellipse_form_factor(const UnshadowedLight& seen) {
  const UnshadowedLight::Frame frame = seen.frame();
  return form_factor(FormFactorEllipse{frame.center, frame.u, frame.v}, seen.normal());
}

}  // namespace

const LightBehaviour kEllipseBehaviour{make_ellipse, is_round_above_horizon, ellipse_form_factor};

}  // namespace penumbra::visibility
