// SPDX-License-Identifier: Apache-2.0
// Rectangles, or parallelograms: the square [−1, 1]² of the frame.

#include "visibility/lights/kinds/light_kinds.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <variant>

namespace penumbra::visibility {
namespace {

void make_rectangle(const scenes::LightShape& shape, const LightBuilder& to) {
  const auto& [c, u, v] = std::get<scenes::Rectangle>(shape);
  to.light.area = 4 * glm::length(glm::cross(u, v));
  if (!(to.light.area > 0)) to.refuse_zero_area(" (halfU and halfV are parallel or zero)");
  to.store_frame(c, c + u, c + v);
  to.store_outline(c, u, v);
  for (const glm::dvec2& sample : to.unit) {
    const glm::dvec2 st = 2.0 * sample - 1.0;
    to.add_sample(st, c + st.x * u + st.y * v);
  }
}

bool is_rectangle_above_horizon(const UnshadowedLight& seen) {
  const UnshadowedLight::Frame frame = seen.frame();
  return frame.height > std::abs(frame.height_u) + std::abs(frame.height_v);
}

double rectangle_form_factor(const UnshadowedLight& seen) {
  return seen.box(glm::dvec2(-1), glm::dvec2(1));
}

}  // namespace

const LightBehaviour kRectangleBehaviour{make_rectangle, is_rectangle_above_horizon, rectangle_form_factor};

}  // namespace penumbra::visibility
