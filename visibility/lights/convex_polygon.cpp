// SPDX-License-Identifier: Apache-2.0
// Clips convex polygons at axis-parallel lines (Sutherland and Hodgman 1974).

#include "visibility/lights/convex_polygon.hpp"

#include <glm/common.hpp>

#include <cmath>
#include <cstddef>

namespace penumbra::visibility {
namespace {

/// Returns the part where sign · coordinate ≤ sign · limit.
std::vector<glm::dvec2> clipped(const std::vector<glm::dvec2>& polygon, int axis, double limit, double sign) {
  const auto in = [&](const glm::dvec2& corner) { return sign * corner[axis] <= sign * limit; };
  std::vector<glm::dvec2> inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (in(a)) inside.push_back(a);
    if (in(a) != in(b)) inside.push_back(glm::mix(a, b, (limit - a[axis]) / (b[axis] - a[axis])));
  }
  return inside;
}

}  // namespace

std::vector<glm::dvec2> clipped_above(const std::vector<glm::dvec2>& polygon, int axis, double limit) {
  return clipped(polygon, axis, limit, 1);
}

std::vector<glm::dvec2> clipped_below(const std::vector<glm::dvec2>& polygon, int axis, double limit) {
  return clipped(polygon, axis, limit, -1);
}

double area_of(const std::vector<glm::dvec2>& polygon) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const glm::dvec2 b = polygon[i] - polygon[0], c = polygon[i + 1] - polygon[0];
    twice += b.x * c.y - b.y * c.x;
  }
  return std::abs(twice) / 2;
}

}  // namespace penumbra::visibility
