#include "maps/light_frame.hpp"

#include "base/assert.hpp"

#include <glm/geometric.hpp>

namespace penumbra::maps {
namespace {

/// Of a flat convex outline: the mean of its fan triangles' centroids, weighted by area.
glm::dvec3 centroid(const std::vector<glm::vec3>& outline, const glm::dvec3& normal) {
  const glm::dvec3 a = outline.front();
  glm::dvec3 sum{0};
  double area = 0;
  for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
    const glm::dvec3 b = glm::dvec3(outline[i]) - a, c = glm::dvec3(outline[i + 1]) - a;
    const double weight = glm::dot(glm::cross(b, c), normal);
    sum += weight * (b + c) / 3.0;
    area += weight;
  }
  return a + sum / area;
}

}  // namespace

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
  frame.center = light.kind == visibility::LightKind::polygon ? centroid(light.outline, frame.n) : c;
  return frame;
}

}  // namespace penumbra::maps
