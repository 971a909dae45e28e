// SPDX-License-Identifier: Apache-2.0
// Depth of a point in the outer penumbra of an edge (E. Haines, Soft planar shadows using plateaus, 2001), on the
// point's own plane.

#include "volumes/soft/outer_penumbra.hpp"

#include "volumes/soft/plateaus.shared.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra::volumes {

double OuterPenumbra::depth_at(const glm::dvec3& p, const glm::dvec3& normal, const glm::dvec3& a,
                               const glm::dvec3& b) const {
  // Heights over the plane, relative to the light's; the part of the edge between the plane and the light.
  const double height = glm::dot(normal, center - p);
  const double at_a = glm::dot(normal, a - p) / height, at_b = glm::dot(normal, b - p) / height;
  double first = 0, last = 1;
  const auto cut = [&](double d, double e) {
    if (d < 0 && e < 0) last = -1;
    if (d < 0 && e >= 0) first = std::max(first, d / (d - e));
    if (d >= 0 && e < 0) last = std::min(last, d / (d - e));
  };
  cut(at_a, at_b);
  cut(gpu::kHighest - at_a, gpu::kHighest - at_b);
  if (!(first <= last)) return 0;
  // Projections of the ends onto the plane, relative to p, and the radii of their disks.
  const auto end = [&](double t, double& reach) {
    const glm::dvec3 x = a + t * (b - a);
    const double h = at_a + t * (at_b - at_a);
    reach = radius * h / (1 - h);
    return center + (x - center) / (1 - h) - p;
  };
  double r = 0, s = 0;
  const glm::dvec3 from = end(first, r), to = end(last, s), direction = to - from;
  // Minimises over t the length of from + t direction divided by the radius r + t (s − r). The minimum is where the
  // derivative is 0, or at an end.
  const double square = glm::dot(direction, direction), slope = s - r;
  double nearest = 0;
  if (square > 0) {
    const double foot = -glm::dot(from, direction) / square, at_foot = r + foot * slope;
    const glm::dvec3 off = from + foot * direction;
    nearest = at_foot > 0 ? foot + slope * glm::dot(off, off) / (square * at_foot) : slope > 0 ? 1 : 0;
  }
  nearest = std::clamp(nearest, 0.0, 1.0);
  const double reach = r + nearest * slope;
  return reach > 0 ? std::clamp(1 - glm::length(from + nearest * direction) / reach, 0.0, 1.0) : 0;
}

}  // namespace penumbra::volumes
