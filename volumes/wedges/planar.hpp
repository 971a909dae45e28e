// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace penumbra::volumes {

/// Corners in the light's plane, in order.
using Polygon = std::vector<glm::dvec2>;

/// Returns the z component of a × b.
inline double cross2(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// Returns the signed area: positive if the corners run counter-clockwise. Computed relative to corner 0, so that
/// little cancels far from the origin.
inline double area_of(const Polygon& polygon) {
  double doubled = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    doubled += cross2(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
  }
  return doubled / 2;
}

/// Returns the corners of the convex hull, counter-clockwise, without points on its edges (Andrew's monotone chain).
inline Polygon hull_of(Polygon points) {
  if (points.empty()) return points;
  std::ranges::sort(points, [](const auto& a, const auto& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  Polygon hull;
  const auto extend = [&](const glm::dvec2& p, std::size_t floor) {
    while (hull.size() >= floor + 2 && cross2(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0) {
      hull.pop_back();
    }
    hull.push_back(p);
  };
  for (const glm::dvec2& p : points) extend(p, 0);
  const std::size_t lower = hull.size() - 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) extend(points[i], lower);
  hull.pop_back();
  return hull;
}

/// Returns the largest magnitude among the components.
inline double largest(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

}  // namespace penumbra::volumes
