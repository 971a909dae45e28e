// SPDX-License-Identifier: Apache-2.0
// Computes the basis, bounds and outline of a light for its maps.

#include "maps/host/light_basis.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace penumbra::maps {
glm::dvec3 LightBasis::local(const glm::dvec3& x) const {
  const glm::dvec3 d = x - center;
  return {glm::dot(d, u), glm::dot(d, v), glm::dot(d, n)};
}

LightBasis light_basis(const visibility::Light& light) {
  const visibility::LightFrame frame = visibility::light_frame(light);
  LightBasis basis;
  basis.u = glm::normalize(frame.u);
  basis.n = glm::normalize(glm::cross(basis.u, frame.v));
  basis.v = glm::cross(basis.n, basis.u);
  basis.center = visibility::center_of(light);
  return basis;
}

LightBasis light_basis(const visibility::Light& light, const visibility::SceneFloats& scene) {
  if (!is_body(light.kind)) return light_basis(light);
  LightBasis basis;
  basis.center = light.center;
  const glm::dvec3 direction = 0.5 * (glm::dvec3(scene.lower) + glm::dvec3(scene.upper)) - basis.center,
                   far = glm::abs(direction);
  int axis = 1;
  if (far.x > far[axis]) axis = 0;
  if (far.z > far[axis]) axis = 2;
  basis.n[axis] = direction[axis] > 0 ? 1 : -1;
  basis.u[(axis + 1) % 3] = 1;
  basis.v = glm::cross(basis.n, basis.u);
  return basis;
}

LightBounds light_bounds(const visibility::Light& light, const LightBasis& basis) {
  if (is_circle(light.kind)) return {glm::dvec2(-light.radius), glm::dvec2(light.radius)};
  LightBounds bounds;
  if (is_round(light.kind)) {
    const LightAxes axes = light_axes(light, basis);
    bounds.upper = {std::hypot(axes.u.x, axes.v.x), std::hypot(axes.u.y, axes.v.y)};
    bounds.lower = -bounds.upper;
    return bounds;
  }
  for (const glm::vec3& corner : light.outline) {
    const glm::dvec2 at(basis.local(corner));
    bounds.lower = glm::min(bounds.lower, at);
    bounds.upper = glm::max(bounds.upper, at);
  }
  return bounds;
}

LightAxes light_axes(const visibility::Light& light, const LightBasis& basis) {
  const visibility::LightFrame frame = visibility::light_frame(light);
  const auto in_basis = [&](const glm::dvec3& d) { return glm::dvec2(glm::dot(d, basis.u), glm::dot(d, basis.v)); };
  return {in_basis(frame.u), in_basis(frame.v)};
}

std::vector<glm::dvec2> light_outline(const visibility::Light& light, const LightBasis& basis) {
  std::vector<glm::dvec2> outline;
  if (is_round(light.kind) && !is_circle(light.kind)) {
    constexpr std::uint32_t kSides = 256;
    constexpr double kStep = 2 * std::numbers::pi / kSides;
    const double reach = std::sqrt(kStep / std::sin(kStep));  // area π for m = kSides sides: ½ m reach² sin(2π/m) = π
    const LightAxes axes = light_axes(light, basis);
    for (std::uint32_t i = 0; i < kSides; ++i) {
      const double angle = kStep * (i + 0.5);
      outline.push_back(reach * (std::cos(angle) * axes.u + std::sin(angle) * axes.v));
    }
    return outline;
  }
  for (const glm::vec3& corner : light.outline) outline.emplace_back(basis.local(corner));
  return outline;
}

}  // namespace penumbra::maps
