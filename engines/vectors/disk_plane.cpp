// SPDX-License-Identifier: Apache-2.0
// Casters at the plane of the disk that a view sample sees of a sphere. See docs/edge-scatter.md, "Ends".

#include "engines/vectors/disk_plane.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra::vectors {
namespace {

constexpr double kRoundingTo = 0x1p-24;

}  // namespace

DiskPlane::DiskPlane(const LightCone& cone, const glm::dvec3& from)
    : p(from),
      axis(glm::normalize(cone.middle)),
      u(cone.u / glm::dot(cone.u, cone.u)),
      v(cone.v / glm::dot(cone.v, cone.v)),
      end(glm::length(cone.middle)) {}

double slab_of(const LightGrid::Cones& cones) {
  return 4 * static_cast<double>(cones.deviation) + 512 * kRoundingTo * cones.reach;
}

double around_disk(const LightGrid::Cones& cones, const LightCone& cone) {
  const double height = glm::length(cone.middle), radius = glm::length(cone.u);
  const auto deviation = static_cast<double>(cones.deviation);
  const double off = 8 * cones.reach / height * 24 * kRoundingTo * (height / radius + 1) + 12 * kRoundingTo +
                     deviation / height + deviation / radius;
  return 1 + 0x1p-6 + 8 * off + 4 * slab_of(cones) / height;
}

bool meets_disk(const DiskPlane& plane, const NearCaster& caster, double slab, double around) {
  if (std::abs(plane.height(caster.middle)) > caster.radius + slab) return false;  // the usual case
  const std::array<glm::dvec3, 3>& corners = caster.corners;
  const std::array heights{plane.height(corners[0]), plane.height(corners[1]), plane.height(corners[2])};
  if (std::ranges::min(heights) > slab || std::ranges::max(heights) < -slab) return false;
  glm::dvec2 low{INFINITY}, high{-INFINITY};
  const auto add = [&](const glm::dvec2& place) {
    low = glm::min(low, place);
    high = glm::max(high, place);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    const glm::dvec2 a = plane.place(corners[i]), b = plane.place(corners[next]);
    if (std::abs(heights[i]) <= slab) add(a);
    for (const double level : {-slab, slab}) {
      if ((heights[i] < level) == (heights[next] < level)) continue;
      add(a + (level - heights[i]) / (heights[next] - heights[i]) * (b - a));
    }
  }
  return low.x <= around && low.y <= around && high.x >= -around && high.y >= -around;
}

}  // namespace penumbra::vectors
