// SPDX-License-Identifier: Apache-2.0
// View-sample mapping on a processor: places of a vector of triangles on the light as one view sample sees them. Inside
// vsm/ only. Bounds: docs/view-sample.md.

#if defined(PENUMBRA_VSM_VECTORS_PROJECT_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_VSM_VECTORS_PROJECT_INL_HPP
#undef PENUMBRA_VSM_VECTORS_PROJECT_INL_HPP
#else
#define PENUMBRA_VSM_VECTORS_PROJECT_INL_HPP
#endif

#include "engines/vectors/hull-inl.hpp"
#include "engines/vectors/pack-inl.hpp"
#include "engines/vectors/vectors-inl.hpp"
#include "vsm/vectors/pairs.hpp"

#include <algorithm>
#include <array>

HWY_BEFORE_NAMESPACE();
namespace penumbra::vsm::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vectors::HWY_NAMESPACE;

constexpr std::size_t kGroup = 16;   // view samples that preselect triangles together
constexpr std::size_t kChunk = 256;  // triangles between two checks of whether anything is left to hide

[[maybe_unused]] V column(const TriangleTable& table, std::size_t field, std::size_t i) {
  return hn::Load(D(), table[field] + i);
}

/// Returns the triangles that the hull may meet.
[[maybe_unused]] M hull_meets(const Hull& hull, const TriangleTable& table, std::size_t i) {
  std::array<Corners, 3> corners;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    corners[corner] = {column(table, kCornerA + 3 * corner, i), column(table, kCornerA + 3 * corner + 1, i),
                       column(table, kCornerA + 3 * corner + 2, i)};
  }
  return meets(hull, corners);
}

/// Selects the triangles of the cluster that the group's hull may meet.
[[maybe_unused]] void sort_out(const PairInput& in, std::span<const ClusterSample> group, TriangleTable& near) {
  const Hull hull = hull_of(in.grid, in.cluster, group);
  near.count = 0;
  near.reserve(in.triangles.count);
  for (std::size_t i = 0; i < in.triangles.count; i += hn::Lanes(D())) {
    const M kept = hn::And(first_lanes(in.triangles.count - i), hull_meets(hull, in.triangles, i));
    const std::size_t more = hn::CountTrue(D(), kept);
    if (more == 0) continue;
    for (std::size_t field = 0; field < kTriangleFields; ++field) {
      pack(column(in.triangles, field, i), kept, D(), near[field] + near.count);
    }
    near.count += more;
  }
}

/// Calls `test(index)` for each view sample, with the triangles of its group in scratch.near.
template <typename Test>
void for_each_in_groups(const PairInput& in, PairScratch& scratch, Test test) {
  for (std::size_t first = 0; first < in.samples.size(); first += kGroup) {
    const auto group = in.samples.subspan(first, std::min(kGroup, in.samples.size() - first));
    sort_out(in, group, scratch.near);
    for (std::size_t i = first; i < first + group.size(); ++i) test(i);
  }
}

/// Fills scratch.survivors with the triangles of scratch.near that may cover a light sample.
class Projection {
 public:
  Projection(const PairInput& in, PairScratch& scratch, const ClusterSample& at)
      : in_(in), s_(scratch), at_(at), place_(at.on_light) {
    const LightGrid& grid = in.grid;
    // (bound near the plane): for a sphere's disk a height has a larger error, and for a sun there is no plane.
    ends_at_ = !grid.cones       ? at.height - 128 * kRound * grid.reach - grid.deviation
               : grid.cones->end ? place_.height - 512 * kRound * grid.reach - 4 * grid.cones->deviation
                                 : 3e38F;
  }

  /// Projects the triangles from index `i` on, one in each lane. Those that floats cannot place are added to
  /// scratch.again.
  void operator()(std::size_t i, std::size_t end) {
    const D d;
    const TriangleTable& near = s_.near;
    const M live = hn::AndNot(same_bits(column(near, kTrianglePlane, i), bits(at_.plane)), first_lanes(end - i));
    const Directions a = direction_to(kCornerA, i), b = direction_to(kCornerB, i), c = direction_to(kCornerC, i);
    const V least = hn::Min(a.w, hn::Min(b.w, c.w)), most = hn::Max(a.w, hn::Max(b.w, c.w));
    const V far = hn::Add(column(near, kTriangleFar, i), set(at_.far));
    const V triangle = hn::BitCast(d, numbers_from(i));
    const M clear = hn::And(hn::Gt(least, hn::Mul(set(4 * place_.through_p), far)), hn::Lt(most, set(ends_at_)));
    const M unclear = hn::AndNot(clear, live);
    if (!hn::AllFalse(d, unclear)) {
      if (!has_hull_) hull_ = hull_of(in_.grid, in_.cluster, std::span(&at_, 1));
      has_hull_ = true;
      look_again(hn::And(unclear, hull_meets(hull_, near, i)), triangle);
    }
    const V qa = hn::Div(set(place_.height), a.w), qb = hn::Div(set(place_.height), b.w),
            qc = hn::Div(set(place_.height), c.w);
    const V foot_x = set(place_.foot.x), foot_y = set(place_.foot.y);
    const V ax = hn::MulAdd(qa, a.x, foot_x), bx = hn::MulAdd(qb, b.x, foot_x), cx = hn::MulAdd(qc, c.x, foot_x);
    const V ay = hn::MulAdd(qa, a.y, foot_y), by = hn::MulAdd(qb, b.y, foot_y), cy = hn::MulAdd(qc, c.y, foot_y);
    const V low_x = hn::Min(ax, hn::Min(bx, cx)), high_x = hn::Max(ax, hn::Max(bx, cx));
    const V low_y = hn::Min(ay, hn::Min(by, cy)), high_y = hn::Max(ay, hn::Max(by, cy));
    // (bound X)
    const V from_foot = hn::Add(hn::Max(hn::Sub(high_x, foot_x), hn::Sub(foot_x, low_x)),
                                hn::Max(hn::Sub(high_y, foot_y), hn::Sub(foot_y, low_y)));
    const V direction = hn::Mul(far, hn::Mul(hn::Max(qa, hn::Max(qb, qc)), set(1.0001F / place_.height)));
    const V error = hn::MulAdd(direction, hn::MulAdd(set(place_.per_reach), from_foot, set(place_.per_ray)),
                               hn::MulAdd(set(place_.per_foot), from_foot, set(place_.fixed)));
    const M kept = hn::And(hn::And(live, clear), reaches(low_x, high_x, low_y, high_y, error));
    const std::size_t more = hn::CountTrue(d, kept);
    if (more == 0) return;
    SurvivorTable& out = s_.survivors;
    const auto store = [&](std::size_t field, V v) { pack(v, kept, d, out[field] + out.count); };
    store(kX0, ax);
    store(kY0, ay);
    store(kX1, bx);
    store(kY1, by);
    store(kX2, cx);
    store(kY2, cy);
    store(kError, error);
    store(kTriangle, triangle);
    out.count += more;
  }

  /// Records triangles (rows of scratch.near) that vectors of floats cannot decide.
  void look_again(M which, V triangle) {
    HWY_ALIGN std::uint32_t numbers[hn::MaxLanes(D())];
    const hn::RebindToUnsigned<D> words;
    hn::Store(hn::BitCast(words, triangle), words, numbers);
    for_each_lane(which, [&](std::size_t lane) { s_.again.push_back(numbers[lane]); });
  }

 private:
  struct Directions {
    V x, y, w;
  };
  [[nodiscard]] Directions direction_to(std::size_t corner, std::size_t i) const {
    const Directions direction{hn::Sub(column(s_.near, corner, i), set(at_.in_grid.x)),
                               hn::Sub(column(s_.near, corner + 1, i), set(at_.in_grid.y)),
                               hn::Sub(set(at_.in_grid.z), column(s_.near, corner + 2, i))};
    return in_.grid.cones ? Directions{turned(direction, 0), turned(direction, 1), turned(direction, 2)} : direction;
  }
  /// Returns one coordinate of a direction in the axes in which p sees a sphere or sun.
  [[nodiscard]] V turned(const Directions& direction, glm::length_t row) const {
    return hn::MulAdd(set(at_.turn[2][row]), direction.w,
                      hn::MulAdd(set(at_.turn[1][row]), direction.y, hn::Mul(set(at_.turn[0][row]), direction.x)));
  }
  /// Returns whether the box may contain a light sample. For tiles: whether it is not certainly outside of all cells.
  [[nodiscard]] M reaches(V low_x, V high_x, V low_y, V high_y, V error) const {
    const LightGrid& grid = in_.grid;
    const V last_row = set(static_cast<float>(grid.rows) - 1), right = set(static_cast<float>(grid.columns) - 0.5F);
    if (grid.tiles) {
      const M beside_x = hn::Or(hn::Gt(hn::Sub(low_x, error), right), hn::Lt(hn::Add(high_x, error), set(-0.5F)));
      const M beside_y = hn::Or(hn::Gt(hn::Sub(low_y, error), hn::Add(last_row, set(0.5F))),
                                hn::Lt(hn::Add(high_y, error), set(-0.5F)));
      return hn::Not(hn::Or(beside_x, beside_y));
    }
    const V first = hn::Max(hn::Ceil(hn::Sub(low_y, error)), set(0)),
            last = hn::Min(hn::Floor(hn::Add(high_y, error)), last_row);
    return hn::And(hn::And(hn::Le(hn::Sub(low_x, error), right), hn::Ge(hn::Add(high_x, error), set(-0.5F))),
                   hn::Le(first, last));
  }

  const PairInput& in_;
  PairScratch& s_;
  const ClusterSample& at_;
  const vectors::Placing& place_;
  float ends_at_ = 0;
  Hull hull_;
  bool has_hull_ = false;
};

}  // namespace
}  // namespace penumbra::vsm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // once for each target
