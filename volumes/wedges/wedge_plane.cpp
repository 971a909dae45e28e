// SPDX-License-Identifier: Apache-2.0
// Decides by exact signs whether a half-space contains a penumbra, and rounds half-spaces outward until it does
// (wedge_plane.hpp derives the criterion). Not from a paper.

#include "volumes/wedges/wedge_plane.hpp"

#include "mesh/predicates.hpp"
#include "volumes/wedges/planar.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace penumbra::volumes {
namespace {

/// Returns whether n · (x − l) ≥ 0 for both ends and all corners.
bool leads_away(const glm::dvec3& n, const EdgeAndLight& cast) {
  return std::ranges::all_of(
      cast.light, [&](const glm::dvec3& l) { return sign_along(n, cast.a, l) >= 0 && sign_along(n, cast.b, l) >= 0; });
}

/// Returns the point of the segment v w nearest to zero.
glm::dvec3 nearest_to_zero(const glm::dvec3& v, const glm::dvec3& w) {
  const glm::dvec3 d = w - v;
  const double length2 = glm::dot(d, d);
  const double t = length2 > 0 ? std::clamp(-glm::dot(v, d) / length2, 0.0, 1.0) : 0.0;
  return v + t * d;
}

glm::dvec3 middle_of(std::span<const glm::dvec3> points) {
  glm::dvec3 sum(0);
  for (const glm::dvec3& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

/// Keeps the best of all offered directions (and their opposites): the one along which edge and light are farthest
/// apart.
class Best {
 public:
  explicit Best(const EdgeAndLight& cast) : cast_(cast) {}

  void offer(const glm::dvec3& direction) {
    const double length = glm::length(direction);
    if (!(length > 0) || !std::isfinite(length)) return;
    const glm::dvec3 m = direction / length;
    const double a = glm::dot(m, cast_.a), b = glm::dot(m, cast_.b);
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (const glm::dvec3& l : cast_.light) {
      lowest = std::min(lowest, glm::dot(m, l));
      highest = std::max(highest, glm::dot(m, l));
    }
    const double above = std::min(a, b) - highest, below = lowest - std::max(a, b);
    if (std::max(above, below) <= gap_) return;
    gap_ = std::max(above, below);
    direction_ = above > below ? m : -m;
  }

  /// Returns nullopt unless the direction separates edge and light exactly.
  [[nodiscard]] std::optional<glm::dvec3> direction() const {
    if (gap_ <= 0) return std::nullopt;
    const bool separates = std::ranges::all_of(cast_.light, [&](const glm::dvec3& l) {
      return sign_along(direction_, cast_.a, l) > 0 && sign_along(direction_, cast_.b, l) > 0;
    });
    return separates ? std::optional(direction_) : std::nullopt;
  }

 private:
  const EdgeAndLight& cast_;
  double gap_ = 0;
  glm::dvec3 direction_{0};
};

}  // namespace

int side_of(const Plane& plane, const glm::dvec3& p) {
  return mesh::sign_of_products(std::array{plane.a, plane.b, plane.c, plane.d}, std::array{p.x, p.y, p.z, 1.0});
}

int sign_along(const glm::dvec3& n, const glm::dvec3& x, const glm::dvec3& l) {
  return mesh::sign_of_products(std::array{n.x, n.y, n.z, n.x, n.y, n.z}, std::array{x.x, x.y, x.z, -l.x, -l.y, -l.z});
}

bool bounds_penumbra(const Plane& plane, const EdgeAndLight& cast) {
  return side_of(plane, cast.a) >= 0 && side_of(plane, cast.b) >= 0 && leads_away(plane.normal(), cast);
}

std::optional<Plane> bounding_plane(glm::dvec3 normal, const EdgeAndLight& cast, const glm::dvec3& inward,
                                    const std::optional<glm::dvec3>& through) {
  const double size = largest(normal);
  if (!(size > 0) || !std::isfinite(size)) return std::nullopt;
  normal /= size;
  const glm::dvec3 turn = inward / largest(inward), wanted = normal;
  for (double share = 0x1p-53; !leads_away(normal, cast); share *= 2) {
    if (share > 0x1p-20) return std::nullopt;
    normal = wanted + share * turn;
  }
  const auto offset = [&](const glm::dvec3& x) { return -glm::dot(normal, x); };
  Plane plane{normal.x, normal.y, normal.z, 0};
  plane.d = through ? offset(*through) : std::max(offset(cast.a), offset(cast.b));
  const double reach = std::max({largest(cast.a), largest(cast.b), std::numeric_limits<double>::min()});
  const double wanted_d = plane.d;
  for (double step = 0x1p-53; side_of(plane, cast.a) < 0 || side_of(plane, cast.b) < 0; step *= 2) {
    if (step > 0x1p-20) return std::nullopt;
    plane.d = wanted_d + step * reach;
  }
  return plane;
}

std::optional<glm::dvec3> separating_direction(const EdgeAndLight& cast) {
  Best best{cast};
  // Two disjoint convex shapes are separated along the normal of a face or at right angles to an edge of either shape.
  // For a polygon and a segment, these are the polygon's normal, and the directions at right angles to the segment and
  // to either the normal or a side.
  const std::span<const glm::dvec3> light = cast.light;
  const glm::dvec3 edge = cast.b - cast.a, normal = glm::cross(light[1] - light[0], light[2] - light[0]);
  best.offer(normal);
  best.offer(glm::cross(normal, edge));
  for (std::size_t i = 0; i < light.size(); ++i) {
    const glm::dvec3 side = light[(i + 1) % light.size()] - light[i];
    best.offer(glm::cross(side, edge));
    best.offer(glm::cross(side, normal));
  }
  // Also offers directions from a corner, or from the middle, to the nearest point of the edge: for separation at ends
  // and corners, and for solid hulls.
  for (const glm::dvec3& l : light) best.offer(nearest_to_zero(cast.a - l, cast.b - l));
  best.offer(nearest_to_zero(cast.a - middle_of(light), cast.b - middle_of(light)));
  return best.direction();
}

}  // namespace penumbra::volumes
