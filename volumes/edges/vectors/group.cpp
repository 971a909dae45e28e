// SPDX-License-Identifier: Apache-2.0
// Edge scatter on a processor: selects, for a few neighbouring view samples together, those of their cluster's edges
// and triangles that affect them. Bounds: docs/edge-scatter.md.

#include "volumes/edges/vectors/group.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volumes/edges/vectors/group.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "engines/vectors/hull-inl.hpp"
#include "engines/vectors/pack-inl.hpp"
#include "engines/vectors/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace penumbra::volumes::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vectors::HWY_NAMESPACE;

struct Box3 {
  glm::vec3 low{0}, high{0};
};
struct GroupBounds {
  Box3 in_grid;  // bounds in (across, along, axis)
  glm::vec3 middle{0}, half_size{0};
  glm::vec2 foot_low{0}, foot_high{0};
  glm::vec2 lean_low{0}, lean_high{0};
  float height_high = 0, far = 0, per_ray = 0, per_reach = 0, per_foot = 0, fixed = 0, per_lean = 0;
  LightGrid::Range window;
  glm::vec3 turned{0};  // bounds of the third row of ClusterSample::turn: largest |x|, largest |y|, smallest z
};

GroupBounds bounds_of(std::span<const ClusterSample> samples) {
  GroupBounds g;
  const ClusterSample& one = samples.front();
  g.in_grid = {one.in_grid, one.in_grid};
  Box3 local{one.local, one.local};
  g.foot_low = g.foot_high = one.foot;
  g.height_high = one.height;
  g.lean_low = g.lean_high = one.lean;
  g.window = one.window;
  g.turned = {0, 0, 1};
  for (const ClusterSample& at : samples) {
    g.in_grid = {glm::min(g.in_grid.low, at.in_grid), glm::max(g.in_grid.high, at.in_grid)};
    local = {glm::min(local.low, at.local), glm::max(local.high, at.local)};
    g.foot_low = glm::min(g.foot_low, at.foot);
    g.foot_high = glm::max(g.foot_high, at.foot);
    g.height_high = std::max(g.height_high, at.height);
    g.far = std::max(g.far, at.far);
    g.per_ray = std::max(g.per_ray, at.on_grid.per_ray);
    g.per_reach = std::max(g.per_reach, at.on_grid.per_reach);
    g.per_foot = std::max(g.per_foot, at.on_grid.per_foot);
    g.fixed = std::max(g.fixed, at.on_grid.fixed);
    g.window = {glm::min(g.window.low, at.window.low), glm::max(g.window.high, at.window.high)};
    const glm::vec3 turned(at.turn[0].z, at.turn[1].z, at.turn[2].z);
    g.turned = glm::vec3(glm::max(glm::vec2(g.turned), glm::abs(glm::vec2(turned))), std::min(g.turned.z, turned.z));
    g.lean_low = glm::min(g.lean_low, at.lean);
    g.lean_high = glm::max(g.lean_high, at.lean);
    g.per_lean = std::max(g.per_lean, at.per_lean);
  }
  g.middle = 0.5F * (local.low + local.high);
  g.half_size = 0.5F * (local.high - local.low) * (1 + 8 * kRound);
  return g;
}

/// Bounds of the place where an edge's end appears from any view sample of the group.
struct Range {
  V low_x, low_y, high_x, high_y, error;
  M bounded;
  V level;  // height over the light's plane
};

class GroupFilter {
 public:
  GroupFilter(const ClusterInput& in, const GroupBounds& g, const Hull& hull) : in_(in), g_(g), hull_(hull) {
    const glm::vec3 from_light = in.cluster.middle - in.grid.center;
    foot_ = glm::vec2(glm::dot(in.grid.across, from_light), glm::dot(in.grid.along, from_light)) + in.grid.first_cell;
    height_ = glm::dot(in.grid.axis, from_light);
  }

  void edges(GroupTable& settled, GroupTable& unsettled) const {
    settled.count = unsettled.count = 0;
    settled.reserve(in_.edges.count);
    unsettled.reserve(in_.edges.count);
    const LightGrid& grid = in_.grid;
    const auto& [low, high] = g_.window;
    for (std::size_t i = 0; i < in_.edges.count; i += hn::Lanes(D())) {
      M kept = hn::And(first_lanes(in_.edges.count - i), may_be_silhouette(i));
      if (hn::AllFalse(D(), kept)) continue;
      const Range a = range_of(kAx, i), b = range_of(kBx, i);
      M bounded = hn::And(a.bounded, b.bounded);
      if (grid.cones) bounded = hn::And(bounded, hn::Gt(hn::Min(a.level, b.level), set(grid.cones->lowest_end)));
      const V low_x = hn::Min(a.low_x, b.low_x), high_x = hn::Max(a.high_x, b.high_x);
      const V low_y = hn::Min(a.low_y, b.low_y), high_y = hn::Max(a.high_y, b.high_y);
      const M before = hn::And(hn::And(hn::Le(low_x, set(high.x)), hn::Ge(high_x, set(low.x))),
                               hn::And(hn::Le(low_y, set(high.y)), hn::Ge(high_y, set(low.y))));
      const M crosses = hn::Or(hn::Lt(low_x, set(-0.5F)), hn::Ge(hn::Floor(high_y), hn::Ceil(low_y)));
      const M matters = in_.between_rows() ? before : hn::And(before, crosses);
      const M behind = hn::Gt(hn::Min(a.level, b.level), set(g_.height_high + 128 * kRound * grid.reach));
      kept = hn::AndNot(behind, kept);
      store(settled, i, hn::And(kept, hn::And(bounded, matters)),
            grid.cones ? column(kFar, i) : hn::Max(a.error, b.error));
      kept = hn::AndNot(bounded, kept);
      if (!hn::AllFalse(D(), kept)) store(unsettled, i, hn::And(kept, in_hull(i)), set(0));
    }
  }

  /// Selects triangles that segments from a p of the group to the light's corner may meet.
  void triangles(TriangleTable& near) const {
    near.count = 0;
    near.reserve(in_.triangles.count);
    for (std::size_t i = 0; i < in_.triangles.count; i += hn::Lanes(D())) {
      const auto column = [&](std::size_t field) { return hn::Load(D(), in_.triangles[field] + i); };
      const V error = hn::Mul(set(1.01F * g_.per_lean), hn::Add(column(kTriangleFar), set(g_.far)));
      M kept = first_lanes(in_.triangles.count - i);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        V least = set(3e38F), most = set(-3e38F);
        for (const std::size_t corner : {std::size_t{kCornerA}, std::size_t{kCornerB}, std::size_t{kCornerC}}) {
          const auto [low, high] = beside_direction(column(corner + axis), column(corner + 2), axis);
          least = hn::Min(least, low);
          most = hn::Max(most, high);
        }
        kept = hn::And(kept, hn::And(hn::Le(least, error), hn::Ge(most, hn::Neg(error))));
      }
      const std::size_t more = hn::CountTrue(D(), kept);
      if (more == 0) continue;
      const auto row = near.row(near.count);
      for (std::size_t field = 0; field < kTriangleFields; ++field) pack(column(field), kept, D(), row[field]);
      near.count += more;
    }
  }

 private:
  /// Returns whether an edge may meet the hull of the group and the light.
  [[nodiscard]] M in_hull(std::size_t i) const {
    return meets(hull_, std::array{Corners{column(kAx, i), column(kAy, i), column(kAh, i)},
                                   Corners{column(kBx, i), column(kBy, i), column(kBh, i)}});
  }

  [[nodiscard]] V column(std::size_t field, std::size_t i) const { return hn::Load(D(), in_.edges[field] + i); }

  struct Interval {
    V low, high;
  };
  /// Returns the distance of a point from the segment from p to the light's corner, along one axis.
  [[nodiscard]] Interval beside_direction(V x, V h, std::size_t axis) const {
    const auto i = static_cast<glm::length_t>(axis);
    const V w_low = hn::Sub(set(g_.in_grid.low.z), h), w_high = hn::Sub(set(g_.in_grid.high.z), h);
    const V low = set(g_.lean_low[i]), high = set(g_.lean_high[i]);
    const V p0 = hn::Mul(low, w_low), p1 = hn::Mul(low, w_high), p2 = hn::Mul(high, w_low), p3 = hn::Mul(high, w_high);
    return {hn::Sub(hn::Sub(x, set(g_.in_grid.high[i])), hn::Max(hn::Max(p0, p1), hn::Max(p2, p3))),
            hn::Sub(hn::Sub(x, set(g_.in_grid.low[i])), hn::Min(hn::Min(p0, p1), hn::Min(p2, p3)))};
  }

  struct Sides {
    M positive, negative, none;
  };
  /// Classifies the side of one of the edges' triangles for all of the group's p. (bound side)
  [[nodiscard]] Sides sides(std::size_t first, std::size_t i) const {
    const V x = column(first, i), y = column(first + 1, i), z = column(first + 2, i);
    const V f = hn::Sub(hn::MulAdd(x, set(g_.middle.x), hn::MulAdd(y, set(g_.middle.y), hn::Mul(z, set(g_.middle.z)))),
                        column(first + kOffset1 - kNormal1X, i));
    const V error = column(first + kOffsetError1 - kNormal1X, i), ax = hn::Abs(x), ay = hn::Abs(y), az = hn::Abs(z);
    const V wide =
        hn::MulAdd(ax, set(g_.half_size.x), hn::MulAdd(ay, set(g_.half_size.y), hn::Mul(az, set(g_.half_size.z))));
    const V ones = hn::Add(ax, hn::Add(ay, az));
    const V spread =
        hn::MulAdd(wide, set(1.001F), hn::MulAdd(error, set(3.2F), hn::Mul(ones, set(4 * kRound * in_.grid.reach))));
    const M none = hn::Lt(error, set(0));
    return {hn::AndNot(none, hn::Gt(f, spread)), hn::AndNot(none, hn::Lt(f, hn::Neg(spread))), none};
  }
  [[nodiscard]] M may_be_silhouette(std::size_t i) const {
    const Sides s = sides(kNormal1X, i), t = sides(kNormal2X, i);
    return hn::Not(
        hn::Or(hn::And(s.none, t.none), hn::Or(hn::And(s.positive, t.negative), hn::And(s.negative, t.positive))));
  }

  /// With h the height of x over the light's plane and H that of p, X' = X + (X − foot) h / (H − h). It is linear in X
  /// − foot and in h / (H − h), so the corners of both ranges bound it. X − foot and H − h are computed as differences
  /// from the cluster's middle, because h / (H − h) may be thousands, and the feet on the light are rounded.
  [[nodiscard]] HWY_INLINE Range range_of(std::size_t first, std::size_t i) const {
    const V x = hn::Add(column(first, i), set(foot_.x)), y = hn::Add(column(first + 1, i), set(foot_.y));
    Range r;
    r.level = hn::Add(column(first + 2, i), set(height_));
    const V below = column(first + 2, i);
    const V w_low = hn::Sub(set(g_.in_grid.low.z), below), w_high = hn::Sub(set(g_.in_grid.high.z), below);
    r.bounded = hn::And(hn::Gt(w_low, hn::Mul(set(0.25F), w_high)), hn::Gt(w_low, set(256 * kRound * in_.grid.reach)));
    if (in_.grid.cones) {
      // A view sample's own axis may differ from the grid's: `own` is a lower bound of the height along any of these
      // axes.
      const auto aside = [&](std::size_t axis) {
        const auto j = static_cast<glm::length_t>(axis);
        const V at = column(first + axis, i);
        return hn::Max(hn::Abs(hn::Sub(at, set(g_.in_grid.low[j]))), hn::Abs(hn::Sub(at, set(g_.in_grid.high[j]))));
      };
      const V own = hn::Sub(hn::Mul(w_low, set(g_.turned.z)),
                            hn::MulAdd(aside(0), set(g_.turned.x), hn::Mul(aside(1), set(g_.turned.y))));
      r.bounded = hn::And(r.bounded, hn::Gt(own, hn::Mul(set(0.25F), w_high)));
    }
    const V inverse = hn::Div(set(1), w_low), at_low = hn::Mul(r.level, inverse), at_high = hn::Div(r.level, w_high);
    const auto span = [&](V from, std::size_t axis) {
      const auto j = static_cast<glm::length_t>(axis);
      const V at = column(first + axis, i), e0 = hn::Sub(at, set(g_.in_grid.high[j])),
              e1 = hn::Sub(at, set(g_.in_grid.low[j]));
      const V p0 = hn::Mul(e0, at_low), p1 = hn::Mul(e0, at_high), p2 = hn::Mul(e1, at_low), p3 = hn::Mul(e1, at_high);
      return std::pair(hn::Add(from, hn::Min(hn::Min(p0, p1), hn::Min(p2, p3))),
                       hn::Add(from, hn::Max(hn::Max(p0, p1), hn::Max(p2, p3))));
    };
    const auto [low_x, high_x] = span(x, 0);
    const auto [low_y, high_y] = span(y, 1);
    const auto away = [&](V low, V high, float foot_low, float foot_high) {
      return hn::Add(hn::Max(hn::Abs(hn::Sub(high, set(foot_low))), hn::Abs(hn::Sub(low, set(foot_high)))),
                     set(foot_high - foot_low));
    };
    const V foot =
        hn::Add(away(low_x, high_x, g_.foot_low.x, g_.foot_high.x), away(low_y, high_y, g_.foot_low.y, g_.foot_high.y));
    V far = hn::Add(column(kFar, i), set(g_.far));
    if (in_.grid.cut_reach > 0)  // see (bound cut)
      far = hn::Add(far, hn::IfThenElseZero(hn::Lt(r.level, set(2 * near_cut(in_.grid))), set(cut_far(in_.grid))));
    const V direction = hn::Mul(far, inverse);
    // (bound X), enlarged by a tenth, since these height differences are computed differently than those of view
    // samples
    r.error = hn::Mul(set(1.1F), hn::MulAdd(direction, hn::MulAdd(set(g_.per_reach), foot, set(g_.per_ray)),
                                            hn::MulAdd(set(g_.per_foot), foot, set(g_.fixed))));
    const V around = hn::Mul(set(4), r.error);
    r.low_x = hn::Sub(low_x, around);
    r.low_y = hn::Sub(low_y, around);
    r.high_x = hn::Add(high_x, around);
    r.high_y = hn::Add(high_y, around);
    return r;
  }

  void store(GroupTable& table, std::size_t i, M kept, V error) const {
    const std::size_t more = hn::CountTrue(D(), kept);
    if (more == 0) return;
    const auto row = table.row(table.count);
    for (std::size_t field = 0; field <= kPlane2; ++field) pack(column(field, i), kept, D(), row[field]);
    pack(error, kept, D(), row[kGroupError]);
    pack(hn::BitCast(D(), numbers_from(i)), kept, D(), row[kGroupEdge]);
    table.count += more;
  }

  const ClusterInput& in_;
  const GroupBounds& g_;
  const Hull& hull_;
  glm::vec2 foot_{0};  // foot of the cluster's middle
  float height_ = 0;
};

void sort_out_here(const ClusterInput& in, std::span<const ClusterSample> group, GroupLists& lists) {
  const GroupBounds bounds = bounds_of(group);
  const Hull hull = hull_of(in.grid, in.cluster, group);
  const GroupFilter filter(in, bounds, hull);

  filter.edges(lists.settled, lists.unsettled);
  filter.triangles(lists.triangles);
}

}  // namespace
}  // namespace penumbra::volumes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::volumes {

void reset_open(const LightGrid& grid, const visibility::LightTouch& touch, const GridSample& at, Open& open) {
  open.clear();
  if (touch.empty()) return;
  open.samples = touch.samples;
  const float farthest = glm::length(at.p - grid.center) + grid.radius;
  open.pixel = touch.any_near && at.height < static_cast<float>(visibility::LightTouch::kFlat) * farthest;
}

HWY_EXPORT(sort_out_here);

void sort_out(const ClusterInput& input, std::span<const ClusterSample> group, GroupLists& lists) {
  HWY_DYNAMIC_DISPATCH(sort_out_here)(input, group, lists);
}

}  // namespace penumbra::volumes
#endif
