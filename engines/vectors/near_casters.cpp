// SPDX-License-Identifier: Apache-2.0
// Finds the casters that may meet the disks of a sphere that a few view samples see: vector tests of bounding spheres.

#include "engines/vectors/near_casters.hpp"

#include "engines/vectors/disk_plane.hpp"
#include "engines/vectors/light_grid.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engines/vectors/near_casters.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "engines/vectors/pack-inl.hpp"

#ifndef PENUMBRA_NEAR_CASTERS_ONCE
#define PENUMBRA_NEAR_CASTERS_ONCE
namespace penumbra::vectors {

/// Bounds of all disks: a piece of the plane through `middle` orthogonal to `axis`.
struct DiskSpan {
  glm::dvec3 axis{0}, middle{0};
  double across = 0;  ///< largest distance of a point of a disk's square from the middle, without the effect of
                      ///< `turned`
  double over = 0;    ///< largest distance of such a point from the plane
  double turned = 0;  ///< added to both for each unit of distance from the middle
};

}  // namespace penumbra::vectors
#endif

HWY_BEFORE_NAMESPACE();
namespace penumbra::vectors::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::ScalableTag<double>;
using Double = hn::Vec<Doubles>;

void find_near_here(const DiskSpan& span, const NearSpheres& among, NearSpheres& out) {
  const Doubles d;
  const auto number = [&](double x) { return hn::Set(d, x); };
  const auto square = [](Double x) { return hn::Mul(x, x); };
  std::size_t count = 0;
  for (std::size_t i = 0; i < among.count; i += hn::Lanes(d)) {
    const auto column = [&](std::size_t field) { return hn::LoadU(d, &among.columns[field][i]); };
    const Double x = hn::Sub(column(NearSpheres::kMiddle), number(span.middle.x)),
                 y = hn::Sub(column(NearSpheres::kMiddle + 1), number(span.middle.y)),
                 z = hn::Sub(column(NearSpheres::kMiddle + 2), number(span.middle.z)),
                 radius = column(NearSpheres::kRadius);
    const Double away = hn::Sqrt(hn::Add(hn::Add(square(x), square(y)), square(z)));
    const Double off = hn::Abs(hn::Add(hn::Add(hn::Mul(x, number(span.axis.x)), hn::Mul(y, number(span.axis.y))),
                                       hn::Mul(z, number(span.axis.z))));
    const auto in_reach = hn::Le(away, hn::Add(radius, number(span.across)));
    const auto in_plane =
        hn::Le(off, hn::Add(hn::Add(radius, number(span.over)), hn::Mul(number(span.turned), hn::Add(away, radius))));
    const auto kept = hn::And(hn::And(in_reach, in_plane), hn::FirstN(d, among.count - i));
    if (hn::AllFalse(d, kept)) continue;
    for (std::size_t field = 0; field < NearSpheres::kFields; ++field)
      pack(column(field), kept, d, &out.columns[field][count]);
    count += hn::CountTrue(d, kept);
  }
  out.count = count;
}

}  // namespace
}  // namespace penumbra::vectors::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::vectors {

HWY_EXPORT(find_near_here);

void NearSpheres::make_room(std::size_t casters) {
  constexpr std::size_t kRoom = 32;  // lanes of the widest vectors
  for (std::vector<double>& column : columns) {
    if (column.size() < casters + kRoom) column.resize(2 * (casters + kRoom));
  }
}

NearCasters side_by_side(std::span<const NearCaster> casters) {
  NearCasters all;
  all.rows.reserve(casters.size() * NearCasters::kRow);
  all.spheres.make_room(casters.size());
  for (const NearCaster& caster : casters) {
    auto& columns = all.spheres.columns;
    const std::size_t i = all.spheres.count++;
    for (glm::length_t axis = 0; axis < 3; ++axis)
      columns[NearSpheres::kMiddle + static_cast<std::size_t>(axis)][i] = caster.middle[axis];
    columns[NearSpheres::kRadius][i] = caster.radius;
    columns[NearSpheres::kNumber][i] = static_cast<double>(i);
    for (const glm::dvec3& corner : caster.corners) all.rows.insert(all.rows.end(), {corner.x, corner.y, corner.z});
    all.rows.push_back(caster.plane);
    all.triangle.push_back(caster.triangle);
  }
  return all;
}

void find_near_disks(const LightGrid& grid, std::span<const GridSample> samples, const NearSpheres& among,
                     NearSpheres& out) {
  out.count = 0;
  if (among.count == 0) return;
  out.make_room(among.count);
  const std::span<const LightCone> cones = grid.cones->of;
  const auto middle_of = [&](const GridSample& at) { return glm::dvec3(at.p) + cones[at.cone].middle; };
  // Bounds of all disks relative to the first: tilt of their planes, offset along its normal, offset of their centres.
  DiskSpan span{glm::normalize(cones[samples.front().cone].middle), middle_of(samples.front())};
  double beside = 0, widest = 0;
  for (const GridSample& at : samples) {
    const LightCone& cone = cones[at.cone];
    const glm::dvec3 other = glm::normalize(cone.middle), aside = span.middle - middle_of(at);
    span.turned = std::max(span.turned, glm::length(other - span.axis));
    beside = std::max(beside, glm::length(aside));
    span.over = std::max(span.over, std::abs(glm::dot(other, aside)));
    widest = std::max(widest, glm::length(cone.u));
  }
  // Rounding is far below a thousandth of the slab.
  const double slab = 1.01 * slab_of(*grid.cones);
  constexpr double kCorner = 1.5 * 1.42;  // distance of a corner, in radii of the disk, for the largest square that is
                                          // not left to exact predicates
  span.across = kCorner * widest + beside + slab;
  span.over += slab;
  HWY_DYNAMIC_DISPATCH(find_near_here)(span, among, out);
}

bool any_may_meet(const DiskPlane& plane, const NearSpheres& casters, double slab, double around) {
  const auto column = [&](std::size_t field) { return casters.columns[field].data(); };
  const double *x = column(NearSpheres::kMiddle), *y = column(NearSpheres::kMiddle + 1),
               *z = column(NearSpheres::kMiddle + 2), *radius = column(NearSpheres::kRadius);
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
#endif
