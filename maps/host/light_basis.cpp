#include "maps/host/light_basis.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

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

LightBounds light_bounds(const visibility::Light& light, const LightBasis& basis) {
  if (light.kind == visibility::LightKind::disk) return {glm::dvec2(-light.radius), glm::dvec2(light.radius)};
  LightBounds bounds;
  for (const glm::vec3& corner : light.outline) {
    const glm::dvec2 at(basis.local(corner));
    bounds.lower = glm::min(bounds.lower, at);
    bounds.upper = glm::max(bounds.upper, at);
  }
  return bounds;
}

}  // namespace penumbra::maps
