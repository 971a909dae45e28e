// SPDX-License-Identifier: Apache-2.0
// Signed edges on a processor: places of a group's edges as one of its view samples sees them. Inside volumes/ only.
// Bounds: docs/edge-scatter.md.

#if defined(PENUMBRA_VOLUMES_PROJECTION_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_VOLUMES_PROJECTION_INL_HPP
#undef PENUMBRA_VOLUMES_PROJECTION_INL_HPP
#else
#define PENUMBRA_VOLUMES_PROJECTION_INL_HPP
#endif

#include "engines/vectors/disk_plane.hpp"
#include "engines/vectors/pack-inl.hpp"
#include "engines/vectors/vectors-inl.hpp"
#include "volumes/edges/vectors/group.hpp"

HWY_BEFORE_NAMESPACE();
namespace penumbra::volumes::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vectors::HWY_NAMESPACE;

/// k_e at p, and whether rounding leaves it open. Evaluated in a fixed order, without fused multiplications, since the
/// same sign must result for all edges of a triangle.
struct Multiplicity {
  V k;
  M open;
};
[[maybe_unused]] HWY_INLINE Multiplicity multiplicity(const GroupTable& table, const ClusterSample& at, std::size_t i) {
  const D d;
  Multiplicity m{hn::Zero(d), hn::FirstN(d, 0)};
  for (const std::size_t first : {std::size_t{kNormal1X}, std::size_t{kNormal2X}}) {
    const auto column = [&](std::size_t offset) { return hn::Load(d, table[first + offset] + i); };
    const V f = hn::Sub(hn::Add(hn::Add(hn::Mul(column(0), set(at.local.x)), hn::Mul(column(1), set(at.local.y))),
                                hn::Mul(column(2), set(at.local.z))),
                        column(kOffset1 - kNormal1X));
    const M counts = hn::AndNot(same_bits(column(kPlane1 - kNormal1X), bits(at.plane)), hn::Ne(f, set(0)));
    m.k = hn::Add(m.k, hn::IfThenElseZero(counts, hn::CopySign(set(1), f)));
    const M open = hn::Le(hn::Abs(f), column(kOffsetError1 - kNormal1X));
    m.open = hn::Or(m.open, hn::AndNot(same_bits(column(kPlane1 - kNormal1X), bits(at.plane)), open));
  }
  return m;
}

/// Edges that vectors leave to the caller: those in `which`, a mask of a vector that begins at `first`.
struct SpecialEdges {
  const GroupTable& table;
  std::size_t first;
  M which;
  const Multiplicity& multiplicity;
  bool settled;
};

/// Fills the table of crossings of one view sample.
class Projection {
 public:
  Projection(const ClusterInput& in, const ClusterSample& at, const GroupLists& lists, CrossingTable& out)
      : in_(in), at_(at), place_(at.on_light), lists_(lists), out_(out) {}

  /// `special` receives edges whose multiplicity is open, and those that pass through p within rounding.
  template <typename Special>
  void operator()(Special& special) {
    out_.count = 0;
    out_.reserve(lists_.settled.count + lists_.unsettled.count);
    for (std::size_t i = 0; i < lists_.settled.count; i += hn::Lanes(D())) settled(i, special);
    for (std::size_t i = 0; i < lists_.unsettled.count; i += hn::Lanes(D())) unsettled(i, special);
  }

 private:
  /// In exact-area mode undecided multiplicities are stored as NaN; the double-precision stage resolves them.
  [[nodiscard]] M open_ones(const Multiplicity& m) const { return in_.exact_area ? hn::FirstN(D(), 0) : m.open; }
  [[nodiscard]] V sure_or_none(const Multiplicity& m) const {
    return in_.exact_area ? hn::IfThenElse(m.open, set(kUnknown), m.k) : m.k;
  }

  struct Directions {
    V x, y, w;
  };
  [[nodiscard]] Directions direction_to(const GroupTable& table, std::size_t first, std::size_t i) const {
    const auto column = [&](std::size_t field) { return hn::Load(D(), table[first + field] + i); };
    const Directions direction{hn::Sub(column(0), set(at_.in_grid.x)), hn::Sub(column(1), set(at_.in_grid.y)),
                               hn::Sub(set(at_.in_grid.z), column(2))};
    return in_.grid.cones ? Directions{turned(direction, 0), turned(direction, 1), turned(direction, 2)} : direction;
  }
  [[nodiscard]] V turned(const Directions& direction, glm::length_t row) const {
    const auto part = [&](V x, glm::length_t column) { return hn::Mul(set(at_.turn[column][row]), x); };
    return hn::Add(hn::Add(part(direction.x, 0), part(direction.y, 1)), part(direction.w, 2));
  }
  struct LightPoints {
    V x, y;
  };
  [[nodiscard]] LightPoints appears(const Directions& direction) const {
    const V q = hn::Div(set(place_.height), direction.w);
    return {hn::Add(set(place_.foot.x), hn::Mul(q, direction.x)), hn::Add(set(place_.foot.y), hn::Mul(q, direction.y))};
  }

  /// Projects edges well above p.
  template <typename Special>
  HWY_INLINE void settled(std::size_t i, Special& special) {
    const GroupTable& table = lists_.settled;
    const Multiplicity m = multiplicity(table, at_, i);
    const M live = hn::And(first_lanes(table.count - i), hn::Or(m.open, hn::Ne(m.k, set(0))));
    if (hn::AllFalse(D(), live)) return;
    const M open = hn::And(live, open_ones(m));
    if (!hn::AllFalse(D(), open)) special({table, i, open, m, true});
    const Directions a = direction_to(table, kAx, i), b = direction_to(table, kBx, i);
    const LightPoints place_a = appears(a), place_b = appears(b);
    V error = hn::Load(D(), table[kGroupError] + i);
    if (in_.grid.cones) {
      const V far = hn::Add(error, set(at_.far));
      error = hn::Mul(set(1.01F), hn::Max(error_of(place_a, a.w, far), error_of(place_b, b.w, far)));
    }
    keep_crossing({place_a, place_b, sure_or_none(m), error, hn::Load(D(), table[kGroupEdge] + i)},
                  hn::AndNot(open, live));
  }

  /// Projects edges that may come near p's height, or below it. They are clipped as in scatter_precisely. (bound
  /// window)
  template <typename Special>
  void unsettled(std::size_t i, Special& special) {
    const D d;
    const LightGrid& grid = in_.grid;
    const GroupTable& table = lists_.unsettled;
    const Multiplicity m = multiplicity(table, at_, i);
    M live = hn::And(first_lanes(table.count - i), hn::Or(m.open, hn::Ne(m.k, set(0))));
    if (hn::AllFalse(d, live)) return;
    const Directions a = direction_to(table, kAx, i), b = direction_to(table, kBx, i);
    const glm::vec2 window = 2.0F * grid.half_cells + 2.0F, off = place_.foot - grid.first_cell;
    // Lanes past the end of the table hold garbage.
    const V edge = hn::IfThenElseZero(first_lanes(table.count - i), hn::Load(d, table[kGroupEdge] + i));
    const V far = hn::Add(far_of(edge), set(at_.far));
    const V far_a = with_cut(far, a.w), far_b = with_cut(far, b.w);
    const V lift = hn::Mul(set(place_.per_lift), hn::Max(far_a, far_b));
    V from = set(0), to = set(1);
    const auto keep_inside = [&](V inside_a, V inside_b) {
      const V t = hn::Div(inside_a, hn::Sub(inside_a, inside_b));
      const M out_a = hn::Lt(inside_a, set(0)), out_b = hn::Lt(inside_b, set(0));
      from = hn::IfThenElse(out_a, hn::Max(from, hn::IfThenElse(out_b, set(2), t)), from);
      to = hn::IfThenElse(hn::AndNot(out_a, out_b), hn::Min(to, t), to);
    };
    for (int axis = 0; axis < 2; ++axis) {
      const V xa = hn::Add(hn::Mul(axis == 0 ? a.x : a.y, set(place_.height)), hn::Mul(set(off[axis]), a.w));
      const V xb = hn::Add(hn::Mul(axis == 0 ? b.x : b.y, set(place_.height)), hn::Mul(set(off[axis]), b.w));
      const V wide_a = hn::Mul(set(window[axis]), hn::Add(a.w, lift));
      const V wide_b = hn::Mul(set(window[axis]), hn::Add(b.w, lift));
      keep_inside(hn::Sub(wide_a, xa), hn::Sub(wide_b, xb));
      keep_inside(hn::Add(wide_a, xa), hn::Add(wide_b, xb));
    }
    // Clips away parts behind a sphere's disk. (bound ends)
    M at_end = hn::FirstN(d, 0);
    if (at_.meets_end) {
      const V slab = set(static_cast<float>(vectors::slab_of(*grid.cones)) * 1.0001F), end = set(place_.height);
      live = hn::And(live, hn::Lt(hn::Min(a.w, b.w), hn::Add(end, slab)));
      at_end = hn::Gt(hn::Max(a.w, b.w), hn::Sub(end, slab));
    } else if (grid.cones && grid.cones->end) {
      keep_inside(hn::Sub(set(place_.height), a.w), hn::Sub(set(place_.height), b.w));
    }
    live = hn::And(live, hn::Le(from, to));
    if (hn::AllFalse(d, live)) return;
    const auto at = [&](V t, M cut, V x, V y, V uncut) {
      return hn::IfThenElse(cut, hn::Add(hn::Mul(x, hn::Sub(set(1), t)), hn::Mul(y, t)), uncut);
    };
    const M cut_a = hn::Gt(from, set(0)), cut_b = hn::Lt(to, set(1));
    const Directions start{at(from, cut_a, a.x, b.x, a.x), at(from, cut_a, a.y, b.y, a.y),
                           at(from, cut_a, a.w, b.w, a.w)};
    const Directions end{at(to, cut_b, a.x, b.x, b.x), at(to, cut_b, a.y, b.y, b.y), at(to, cut_b, a.w, b.w, b.w)};
    const V far_start = at(from, cut_a, far_a, far_b, far_a), far_end = at(to, cut_b, far_a, far_b, far_b);
    const V through_p = set(place_.through_p);
    const M near_p = hn::Or(hn::Lt(start.w, hn::Mul(through_p, far_start)), hn::Lt(end.w, hn::Mul(through_p, far_end)));
    const M other = hn::And(live, hn::Or(hn::Or(open_ones(m), near_p), at_end));
    if (!hn::AllFalse(d, other)) special({table, i, other, m, false});
    const LightPoints place_a = appears(start), place_b = appears(end);
    const V error =
        hn::Mul(set(1.01F), hn::Max(error_of(place_a, start.w, far_start), error_of(place_b, end.w, far_end)));
    keep_crossing({place_a, place_b, sure_or_none(m), error, hn::Or(edge, bits(kUnsettled))}, hn::AndNot(other, live));
  }

  [[nodiscard]] V far_of(V edge) const { return hn::GatherIndex(D(), in_.edges[kFar], hn::BitCast(I(), edge)); }
  /// Returns the length of an end's vector plus the error of a cut. (bound cut)
  [[nodiscard]] V with_cut(V far, V w) const {
    if (in_.grid.cut_reach == 0) return far;
    const M may_be_cut = hn::Lt(hn::Sub(set(place_.height), w), set(near_cut(in_.grid)));
    return hn::Add(far, hn::IfThenElseZero(may_be_cut, set(cut_far(in_.grid))));
  }
  /// Returns the error of a place. (bound X)
  [[nodiscard]] V error_of(const LightPoints& place, V w, V far) const {
    const V foot =
        hn::Add(hn::Abs(hn::Sub(place.x, set(place_.foot.x))), hn::Abs(hn::Sub(place.y, set(place_.foot.y))));
    return hn::MulAdd(hn::Div(far, w), hn::MulAdd(set(place_.per_reach), foot, set(place_.per_ray)),
                      hn::MulAdd(set(place_.per_foot), foot, set(place_.fixed)));
  }

  /// Returns the edges that some light sample may be right of. Excludes edges that lie completely in a corner of the
  /// grid, right of all light samples: the samples of a disk leave the grid's corners empty.
  [[nodiscard]] M left_of_a_sample(V low_x, V low_y, V high_y) const {
    const float rounding = 8 * kRound * (in_.grid.half_cells.x + in_.grid.half_cells.y);
    const M before = hn::And(hn::Le(hn::Add(low_x, low_y), set(in_.grid.tiles->most_sum + rounding)),
                             hn::Le(hn::Sub(low_x, high_y), set(in_.grid.tiles->most_difference + rounding)));
    return hn::Or(before, hn::Lt(low_x, set(-0.5F)));
  }

  struct ProjectedEdges {
    LightPoints a, b;
    V k, error, number;
  };
  /// Keeps edges that cross light rows or the light's left side, or may do so.
  HWY_INLINE void keep_crossing(const ProjectedEdges& e, M live) {
    const D d;
    const V low_x = hn::Sub(hn::Min(e.a.x, e.b.x), e.error), high_x = hn::Add(hn::Max(e.a.x, e.b.x), e.error);
    const V low_y = hn::Sub(hn::Min(e.a.y, e.b.y), e.error), high_y = hn::Add(hn::Max(e.a.y, e.b.y), e.error);
    const V rows = set(static_cast<float>(in_.grid.rows)), columns = set(static_cast<float>(in_.grid.columns));
    const V first = hn::Max(hn::Ceil(low_y), set(0)), last = hn::Min(hn::Floor(high_y), hn::Sub(rows, set(1)));
    const M left = hn::And(hn::Lt(low_x, set(-0.5F)), hn::And(hn::Ge(high_y, set(-0.5F)), hn::Le(low_y, rows)));
    const M before = hn::And(hn::Le(low_x, columns), hn::Ge(high_x, set(-0.5F)));
    const M on_light = hn::And(hn::Ge(high_y, set(-0.5F)), hn::Le(low_y, rows));
    const M matters = in_.between_rows() ? on_light : hn::Or(left, hn::Le(first, last));
    M kept = hn::And(live, hn::And(before, matters));
    if (in_.grid.tiles && !in_.exact_area) kept = hn::And(kept, left_of_a_sample(low_x, low_y, high_y));
    const std::size_t more = hn::CountTrue(d, kept);
    if (more == 0) return;
    const auto row = out_.row(out_.count);
    const auto store = [&](std::size_t field, V v) { pack(v, kept, d, row[field]); };
    store(kX0, e.a.x);
    store(kY0, e.a.y);
    store(kX1, e.b.x);
    store(kY1, e.b.y);
    store(kK, e.k);
    store(kError, e.error);
    store(kEdge, e.number);
    out_.count += more;
  }

  const ClusterInput& in_;
  const ClusterSample& at_;
  const Placing& place_;
  const GroupLists& lists_;
  CrossingTable& out_;
};

}  // namespace
}  // namespace penumbra::volumes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // once for each target
