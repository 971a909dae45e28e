// SPDX-License-Identifier: Apache-2.0
// Properties of a light in scene floats: its kind, its frame, its centre, its points as p sees them.

#include "visibility/light_samples.hpp"

#include "base/assert.hpp"
#include "visibility/axes_around.hpp"
#include "visibility/sphere_point.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra::visibility {

glm::vec3 center_of(const Light& light) {
  if (!is_polygon(light.kind)) return light.center;
  // The mean of the centroids of a fan's triangles, weighted by area.
  const LightFrame frame = light_frame(light);
  const glm::dvec3 a = light.outline.front(), normal = glm::cross(frame.u, frame.v);
  glm::dvec3 sum{0};
  double area = 0;
  for (std::size_t i = 1; i + 1 < light.outline.size(); ++i) {
    const glm::dvec3 b = glm::dvec3(light.outline[i]) - a, d = glm::dvec3(light.outline[i + 1]) - a;
    const double weight = glm::dot(glm::cross(b, d), normal);
    sum += weight * (b + d) / 3.0;
    area += weight;
  }
  return glm::vec3(a + sum / area);
}

LightFrame light_frame(const Light& light) {
  PENUMBRA_ASSERT(!is_body(light.kind), "light {} is a {} and has no stored axes", light.name, name_of(light.kind));
  const glm::dvec3 c = light.center;
  if (light.sun) {
    return {c, light.sun->tangent * glm::dvec3(light.sun->axis_u), light.sun->tangent * glm::dvec3(light.sun->axis_v)};
  }
  return {c, glm::dvec3(light.center_u) - c, glm::dvec3(light.center_v) - c};
}

LightFrame light_frame_from(const Light& light, const glm::vec3& p) {
  if (!is_body(light.kind)) return light_frame(light);
  const glm::dvec3 c = light.center, q = glm::dvec3(p) - c;
  const double r = light.radius, d = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
  const double touching = (d - r) * (d + r);  // the square of the tangents' length
  if (!(touching > 0)) return {c, glm::dvec3(0), glm::dvec3(0)};
  const Axes axes = axes_around(q / d);
  const double k = (r / d) * (r / d), radius = r * std::sqrt(touching) / d;
  return {c + k * q, radius * axes.u, radius * axes.v};
}

glm::dvec3 direction_to(const Light& light, const glm::vec3& p, const glm::vec3& l) {
  return light.sun ? glm::dvec3(l) : glm::dvec3(l) - glm::dvec3(p);
}

Bounds point_bounds(const Light& light) {
  if (is_body(light.kind)) {
    // The disks are inside the ball; their points are rounded to float32, and so are the bounds.
    const float farthest = std::max({std::abs(light.center.x), std::abs(light.center.y), std::abs(light.center.z)});
    const float reach =
        std::nextafter(static_cast<float>(light.radius) * 1.0001f, std::numeric_limits<float>::infinity()) +
        0x1p-22f * farthest;
    return {light.center - reach, light.center + reach};
  }
  Bounds bounds{light.points.front(), light.points.front()};
  for (const glm::vec3& point : light.points) {
    bounds.lower = glm::min(bounds.lower, point);
    bounds.upper = glm::max(bounds.upper, point);
  }
  return bounds;
}

void light_points_for(const Light& light, const glm::vec3& p, glm::vec3* out) {
  if (!is_body(light.kind)) {
    std::copy(light.points.begin(), light.points.end(), out);
    return;
  }
  const LightFrame frame = light_frame_from(light, p);
  for (const glm::dvec2& st : light.coordinates) {
    *out++ = sphere_point(frame, st);
  }
}

}  // namespace penumbra::visibility
