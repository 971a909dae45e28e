// SPDX-License-Identifier: Apache-2.0
// Makes lights from scenes: parts common to all kinds.

#include "visibility/lights/kinds/light_builder.hpp"

#include "visibility/pair_truth.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace penumbra::visibility {

bool is_finite_point(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

glm::dvec2 concentric_disk(const glm::dvec2& unit) {
  const double a = 2 * unit.x - 1, b = 2 * unit.y - 1;
  if (a == 0 && b == 0) return {0, 0};
  constexpr double kQuarter = std::numbers::pi / 4;
  const bool wide = std::abs(a) > std::abs(b);
  const double radius = wide ? a : b;
  const double angle = wide ? kQuarter * (b / a) : 2 * kQuarter - kQuarter * (a / b);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

glm::vec3 LightBuilder::stored(const glm::dvec3& world) const {
  return glm::vec3(world - origin) + 0.0f;  // + 0 turns −0 into +0
}

void LightBuilder::refuse_zero_area(const std::string& detail) const {
  throw NoArea("light \"{}\": its area is zero{}; an area light needs a shape with an area", light.name, detail);
}

void LightBuilder::store_frame(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v) const {
  light.center = stored(center);
  light.center_u = stored(u);
  light.center_v = stored(v);
  if (!is_finite_point(light.center) || !is_finite_point(light.center_u) || !is_finite_point(light.center_v)) return;
  const LightFrame frame = light_frame(light);
  const glm::dvec3 normal = glm::cross(frame.u, frame.v);
  if (collinear(light.center, light.center_u, light.center_v) ||
      !(glm::dot(normal, glm::cross(u - center, v - center)) > 0)) {
    refuse_zero_area(" in float32 relative to the scene's origin");
  }
}

void LightBuilder::add_sample(const glm::dvec2& coordinate, const glm::dvec3& world) const {
  light.coordinates.push_back(coordinate);
  light.points.push_back(stored(world));
}

void LightBuilder::store_outline(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v) const {
  light.outline = {stored(center - u - v), stored(center + u - v), stored(center + u + v), stored(center - u + v)};
}

void LightBuilder::add_round(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v) const {
  store_frame(center, center + u, center + v);
  store_outline(center, u, v);
  for (const glm::dvec2& sample : unit) {
    const glm::dvec2 st = concentric_disk(sample);
    add_sample(st, center + st.x * u + st.y * v);
  }
}

}  // namespace penumbra::visibility
