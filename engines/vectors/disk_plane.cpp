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
  if (std::abs(plane.height(caster.middle)) > caster.radius + slab) return false;  // as most are
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

void find_near_disks(const LightGrid& grid, std::span<const GridSample> samples, std::span<const NearCaster> among,
                     std::vector<NearCaster>& out) {
  out.clear();
  if (among.empty()) return;
  const std::span<const LightCone> cones = grid.cones->of;
  const auto middle_of = [&](const GridSample& at) { return glm::dvec3(at.p) + cones[at.cone].middle; };
  // The first one's plane and its middle; how the others' are turned against it, pass over that, and have theirs
  // beside.
  const glm::dvec3 axis = glm::normalize(cones[samples.front().cone].middle), middle = middle_of(samples.front());
  double turned = 0, over = 0, beside = 0, widest = 0;
  for (const GridSample& at : samples) {
    const LightCone& cone = cones[at.cone];
    const glm::dvec3 other = glm::normalize(cone.middle), aside = middle - middle_of(at);
    turned = std::max(turned, glm::length(other - axis));
    beside = std::max(beside, glm::length(aside));
    over = std::max(over, std::abs(glm::dot(other, aside)));
    widest = std::max(widest, glm::length(cone.u));
  }
  // Rounding is far less than a thousandth of the slab.
  const double slab = 1.01 * slab_of(*grid.cones);
  constexpr double kCorner = 1.5 * 1.42;  // of the largest square that is not left to exact predicates
  for (const NearCaster& caster : among) {
    const glm::dvec3 from = caster.middle - middle;
    const double away = glm::length(from), reach = away + caster.radius;
    if (away > caster.radius + kCorner * widest + beside + slab) continue;
    if (std::abs(glm::dot(axis, from)) > caster.radius + turned * reach + over + slab) continue;
    out.push_back(caster);
  }
}

void set_near_casters(std::span<const NearCaster> from, NearCasters& to) {
  for (auto& column : to.columns) column.assign(from.size() + NearCasters::kRoom, 0);
  to.triangle.assign(from.size() + NearCasters::kRoom, 0);
  to.plane.assign(from.size() + NearCasters::kRoom, 0);
  to.count = from.size();
  for (std::size_t i = 0; i < from.size(); ++i) {
    const NearCaster& caster = from[i];
    for (glm::length_t axis = 0; axis < 3; ++axis) {
      const auto offset = static_cast<std::size_t>(axis);
      for (std::size_t corner = 0; corner < 3; ++corner)
        to.columns[3 * corner + offset][i] = caster.corners[corner][axis];
      to.columns[NearCasters::kMiddle + offset][i] = caster.middle[axis];
    }
    to.columns[NearCasters::kRadius][i] = caster.radius;
    to.triangle[i] = caster.triangle;
    to.plane[i] = caster.plane;
  }
}

bool any_may_meet(const DiskPlane& plane, const NearCasters& casters, double slab, double around) {
  const auto column = [&](std::size_t field) { return casters.columns[field].data(); };
  const double *x = column(NearCasters::kMiddle), *y = column(NearCasters::kMiddle + 1),
               *z = column(NearCasters::kMiddle + 2), *radius = column(NearCasters::kRadius);
  const double to_corner = 1.42 * around / glm::length(plane.u);
  const glm::dvec3 middle = plane.p + plane.end * plane.axis;
  for (std::size_t i = 0; i < casters.count; ++i) {
    const glm::dvec3 at(x[i], y[i], z[i]);
    if (std::abs(plane.height(at)) > radius[i] + slab) continue;
    const glm::dvec3 from = at - middle;
    const double reach = radius[i] + to_corner + slab;
    if (glm::dot(from, from) <= reach * reach) return true;
  }
  return false;
}

}  // namespace penumbra::vectors
