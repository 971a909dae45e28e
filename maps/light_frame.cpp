#include "maps/light_frame.hpp"

#include "base/assert.hpp"

#include <glm/geometric.hpp>

namespace penumbra::maps {
glm::dvec3 LightFrame::local(const glm::dvec3& x) const {
  const glm::dvec3 d = x - center;
  return {glm::dot(d, u), glm::dot(d, v), glm::dot(d, n)};
}

LightFrame frame_of(const visibility::Light& light) {
  PENUMBRA_ASSERT(light.kind != visibility::LightKind::sphere, "light {} is a sphere and has no plane", light.name);
  const glm::dvec3 c = light.center;
  LightFrame frame;
  frame.u = glm::normalize(glm::dvec3(light.center_u) - c);
  frame.n = glm::normalize(glm::cross(frame.u, glm::dvec3(light.center_v) - c));
  frame.v = glm::cross(frame.n, frame.u);
  frame.center = visibility::center_of(light);
  return frame;
}

}  // namespace penumbra::maps
