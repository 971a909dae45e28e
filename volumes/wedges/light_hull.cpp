// SPDX-License-Identifier: Apache-2.0
// Constructs a convex hull around a light: a circumscribed regular polygon (disk, ellipse) or icosahedron (sphere),
// enlarged by a bound of the rounding error. Not from a paper.

#include "volumes/wedges/light_hull.hpp"

#include "base/assert.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra::volumes {
namespace {

/// Returns the fraction of the radius by which the hull is enlarged, for rounding here and for the displacement of
/// points by storage in float32: half an ulp of each coordinate of the centre and of a point of the rim, less than 2⁻²²
/// of their size.
double margin_of(const visibility::Light& light, double radius) {
  const double farthest = std::max({std::abs(light.center.x), std::abs(light.center.y), std::abs(light.center.z)});
  return 0x1p-20 + 0x1p-22 * (farthest + radius) / radius;
}

/// Returns the hull of a disk or ellipse: a polygon circumscribed to the unit disk, in the frame's coordinates.
LightHull round_hull(const visibility::Light& light, std::uint32_t sides) {
  const auto [center, u, v] = visibility::light_frame(light);
  double least = light.radius, most = light.radius;
  if (!is_circle(light.kind)) {  // bounds of the ellipse's axes, whose squares add up to u² + v²
    most = std::hypot(glm::length(u), glm::length(v));
    least = glm::length(glm::cross(u, v)) / most;
  }
  const double angle = 2 * std::numbers::pi / sides, reach = (1 + margin_of(light, least)) / std::cos(angle / 2);
  LightHull hull{{}, center, most * (reach - 1), false};
  for (std::uint32_t i = 0; i < sides; ++i) {
    hull.corners.push_back(center + reach * (std::cos(i * angle) * u + std::sin(i * angle) * v));
  }
  return hull;
}

/// Returns an icosahedron in which the sphere is inscribed: the distance of its faces is 0.7947 of the distance of its
/// corners.
LightHull sphere_hull(const visibility::Light& light) {
  const double golden = std::numbers::phi;
  // The radii of an icosahedron with edges of length 2.
  const double inradius = golden * golden / std::sqrt(3.0), circumradius = std::sqrt(golden * golden + 1);
  const double scale = light.radius * (1 + margin_of(light, light.radius)) / inradius;
  LightHull hull{{}, glm::dvec3(light.center), circumradius * scale - light.radius, true};
  for (const double one : {-1.0, 1.0}) {
    for (const double other : {-golden, golden}) {
      for (const glm::dvec3& corner :
           {glm::dvec3(0, one, other), glm::dvec3(one, other, 0), glm::dvec3(other, 0, one)}) {
        hull.corners.push_back(hull.center + scale * corner);
      }
    }
  }
  return hull;
}

}  // namespace

LightHull light_hull(const visibility::Light& light, std::uint32_t sides) {
  PENUMBRA_ASSERT(sides >= 3, "{} sides", sides);
  if (is_body(light.kind)) return sphere_hull(light);
  if (is_round(light.kind)) return round_hull(light, sides);
  LightHull hull{{}, glm::dvec3(visibility::center_of(light))};
  for (const glm::vec3& corner : light.outline) hull.corners.emplace_back(corner);
  return hull;
}

}  // namespace penumbra::volumes
