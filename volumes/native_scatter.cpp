// Second stage of edge scatter on a processor: what scatter_edges.comp does, with edges side by side instead of view
// samples. A few neighbouring view samples sort out edges together; each then scatters what is left into its histogram.

#include "volumes/native_scatter.hpp"

#include "volumes/native_precise.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <bit>
#include <cmath>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volumes/native_scatter.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace penumbra::volumes::native::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
using I = hn::RebindToSigned<D>;

constexpr std::size_t kGroup = 8;  // view samples that sort out edges together

V set(float x) {
  return hn::Set(D(), x);
}
V bits(std::uint32_t x) {
  return hn::BitCast(D(), hn::Set(hn::RebindToUnsigned<D>(), x));
}
M same_bits(V x, V y) {
  const hn::RebindToUnsigned<D> words;
  const auto equal = hn::Eq(hn::BitCast(words, x), hn::BitCast(words, y));
  return hn::MaskFromVec(hn::BitCast(D(), hn::VecFromMask(words, equal)));
}
M first_lanes(std::size_t count) {
  return hn::FirstN(D(), count);
}

// ---- which edges matter to a group ---------------------------------------------------------------------------------

struct Box3 {
  glm::vec3 low{0}, high{0};
};
struct GroupBounds {
  Box3 seen;  // (across, along, axis)
  glm::vec3 middle{0}, half_size{0};
  glm::vec2 foot_low{0}, foot_high{0};
  float height_low = 0, height_high = 0, far = 0, per_way = 0, per_foot = 0, fixed = 0;
};

GroupBounds bounds_of(std::span<const Sample> samples) {
  GroupBounds g;
  const Sample& one = samples.front();
  g.seen = {one.seen, one.seen};
  Box3 local{one.local, one.local};
  g.foot_low = g.foot_high = one.foot;
  g.height_low = g.height_high = one.height;
  for (const Sample& at : samples) {
    g.seen = {glm::min(g.seen.low, at.seen), glm::max(g.seen.high, at.seen)};
    local = {glm::min(local.low, at.local), glm::max(local.high, at.local)};
    g.foot_low = glm::min(g.foot_low, at.foot);
    g.foot_high = glm::max(g.foot_high, at.foot);
    g.height_low = std::min(g.height_low, at.height);
    g.height_high = std::max(g.height_high, at.height);
    g.far = std::max(g.far, at.far);
    g.per_way = std::max(g.per_way, at.per_way);
    g.per_foot = std::max(g.per_foot, at.per_foot);
    g.fixed = std::max(g.fixed, at.fixed);
  }
  g.middle = 0.5F * (local.low + local.high);
  g.half_size = 0.5F * (local.high - local.low) * (1 + 8 * kRound);
  return g;
}

/// Where an end of an edge appears for any view sample of the group.
struct Range {
  V low_x, low_y, high_x, high_y, error;
  M bounded;
  V level;  // over the light's plane
};

class GroupFilter {
 public:
  GroupFilter(const ScatterInput& in, const GroupBounds& g, const glm::vec2& middle_foot, float middle_height)
      : in_(in), g_(g), foot_(middle_foot), height_(middle_height) {}

  void operator()(GroupTable& settled, GroupTable& unsettled) const {
    settled.count = unsettled.count = 0;
    settled.reserve(in_.edges.count);
    unsettled.reserve(in_.edges.count);
    const Frame& frame = in_.frame;
    const float columns = static_cast<float>(frame.columns) - 0.5F, rows = static_cast<float>(frame.rows) - 0.5F;
    for (std::size_t i = 0; i < in_.edges.count; i += hn::Lanes(D())) {
      M kept = hn::And(first_lanes(in_.edges.count - i), may_be_silhouette(i));
      if (hn::AllFalse(D(), kept)) continue;
      const Range a = range_of(kAx, i), b = range_of(kBx, i);
      const M bounded = hn::And(a.bounded, b.bounded);
      const V low_x = hn::Min(a.low_x, b.low_x), high_x = hn::Max(a.high_x, b.high_x);
      const V low_y = hn::Min(a.low_y, b.low_y), high_y = hn::Max(a.high_y, b.high_y);
      const M before = hn::And(hn::And(hn::Le(low_x, set(columns)), hn::Ge(high_x, set(-0.5F))),
                               hn::And(hn::Le(low_y, set(rows)), hn::Ge(high_y, set(-0.5F))));
      const M crosses = hn::Or(hn::Lt(low_x, set(-0.5F)), hn::Ge(hn::Floor(high_y), hn::Ceil(low_y)));
      const M behind = hn::Gt(hn::Min(a.level, b.level), set(g_.height_high + 128 * kRound * frame.reach));
      kept = hn::AndNot(behind, kept);
      put(settled, i, hn::And(kept, hn::And(bounded, hn::And(before, crosses))), hn::Max(a.error, b.error));
      put(unsettled, i, hn::AndNot(bounded, kept), set(0));
    }
  }

 private:
  [[nodiscard]] V column(std::size_t field, std::size_t i) const { return hn::Load(D(), in_.edges[field] + i); }

  struct Sides {
    M positive, negative, none;
  };
  /// What one of the edges' triangles is for all of the group's p. (bound side)
  [[nodiscard]] Sides sides(std::size_t first, std::size_t i) const {
    const V x = column(first, i), y = column(first + 1, i), z = column(first + 2, i);
    const V f = hn::Sub(hn::MulAdd(x, set(g_.middle.x), hn::MulAdd(y, set(g_.middle.y), hn::Mul(z, set(g_.middle.z)))),
                        column(first + kD1 - kN1x, i));
    const V error = column(first + kE1 - kN1x, i), ax = hn::Abs(x), ay = hn::Abs(y), az = hn::Abs(z);
    const V wide =
        hn::MulAdd(ax, set(g_.half_size.x), hn::MulAdd(ay, set(g_.half_size.y), hn::Mul(az, set(g_.half_size.z))));
    const V ones = hn::Add(ax, hn::Add(ay, az));
    const V spread =
        hn::MulAdd(wide, set(1.001F), hn::MulAdd(error, set(3.2F), hn::Mul(ones, set(4 * kRound * in_.frame.reach))));
    const M none = hn::Lt(error, set(0));
    return {hn::AndNot(none, hn::Gt(f, spread)), hn::AndNot(none, hn::Lt(f, hn::Neg(spread))), none};
  }
  [[nodiscard]] M may_be_silhouette(std::size_t i) const {
    const Sides s = sides(kN1x, i), t = sides(kN2x, i);
    return hn::Not(
        hn::Or(hn::And(s.none, t.none), hn::Or(hn::And(s.positive, t.negative), hn::And(s.negative, t.positive))));
  }

  /// With h the height of x over the light's plane and H that of p, X' = X + (X − foot) h / (H − h): linear in both, so
  /// the corners bound it.
  [[nodiscard]] Range range_of(std::size_t first, std::size_t i) const {
    const V x = hn::Add(column(first, i), set(foot_.x)), y = hn::Add(column(first + 1, i), set(foot_.y));
    Range r;
    r.level = hn::Add(column(first + 2, i), set(height_));
    const V w_low = hn::Sub(set(g_.height_low), r.level), w_high = hn::Sub(set(g_.height_high), r.level);
    r.bounded = hn::And(hn::Gt(w_low, hn::Mul(set(0.25F), w_high)), hn::Gt(w_low, set(256 * kRound * in_.frame.reach)));
    const V inverse = hn::Div(set(1), w_low), at_low = hn::Mul(r.level, inverse), at_high = hn::Div(r.level, w_high);
    const auto span = [&](V from, float low, float high) {
      const V e0 = hn::Sub(from, set(high)), e1 = hn::Sub(from, set(low));
      const V p0 = hn::Mul(e0, at_low), p1 = hn::Mul(e0, at_high), p2 = hn::Mul(e1, at_low), p3 = hn::Mul(e1, at_high);
      return std::pair(hn::Add(from, hn::Min(hn::Min(p0, p1), hn::Min(p2, p3))),
                       hn::Add(from, hn::Max(hn::Max(p0, p1), hn::Max(p2, p3))));
    };
    const auto [low_x, high_x] = span(x, g_.foot_low.x, g_.foot_high.x);
    const auto [low_y, high_y] = span(y, g_.foot_low.y, g_.foot_high.y);
    const auto away = [&](V low, V high, float foot_low, float foot_high) {
      return hn::Add(hn::Max(hn::Abs(hn::Sub(high, set(foot_low))), hn::Abs(hn::Sub(low, set(foot_high)))),
                     set(foot_high - foot_low));
    };
    const V foot =
        hn::Add(away(low_x, high_x, g_.foot_low.x, g_.foot_high.x), away(low_y, high_y, g_.foot_low.y, g_.foot_high.y));
    const V way = hn::Mul(hn::Add(column(kFar, i), set(g_.far)), inverse);
    // (bound X), a tenth more: the differences of height are not computed like the view samples'
    r.error = hn::Mul(set(1.1F), hn::MulAdd(way, hn::MulAdd(set(kPerReach), foot, set(g_.per_way)),
                                            hn::MulAdd(set(g_.per_foot), foot, set(g_.fixed))));
    const V around = hn::Mul(set(4), r.error);
    r.low_x = hn::Sub(low_x, around);
    r.low_y = hn::Sub(low_y, around);
    r.high_x = hn::Add(high_x, around);
    r.high_y = hn::Add(high_y, around);
    return r;
  }

  void put(GroupTable& table, std::size_t i, M kept, V error) const {
    const std::size_t more = hn::CountTrue(D(), kept);
    if (more == 0) return;
    for (std::size_t field = 0; field <= kPlane2; ++field) {
      hn::CompressStore(column(field, i), kept, D(), table[field] + table.count);
    }
    hn::CompressStore(error, kept, D(), table[kGroupError] + table.count);
    const V numbers = hn::BitCast(D(), hn::Iota(I(), static_cast<std::int32_t>(i)));
    hn::CompressStore(numbers, kept, D(), table[kGroupEdge] + table.count);
    table.count += more;
  }

  const ScatterInput& in_;
  const GroupBounds& g_;
  glm::vec2 foot_;
  float height_;
};

// ---- one view sample -----------------------------------------------------------------------------------------------

/// k_e at p, and whether rounding leaves it open. In one order, without fused multiplications, as everywhere where the
/// same sign must come out for all edges of a triangle.
struct Multiplicity {
  V k;
  M open;
};
Multiplicity multiplicity(const GroupTable& table, const Sample& at, std::size_t i) {
  const D d;
  Multiplicity m{hn::Zero(d), hn::FirstN(d, 0)};
  for (const std::size_t first : {std::size_t{kN1x}, std::size_t{kN2x}}) {
    const auto column = [&](std::size_t offset) { return hn::Load(d, table[first + offset] + i); };
    const V f = hn::Sub(hn::Add(hn::Add(hn::Mul(column(0), set(at.local.x)), hn::Mul(column(1), set(at.local.y))),
                                hn::Mul(column(2), set(at.local.z))),
                        column(kD1 - kN1x));
    const M counts = hn::AndNot(same_bits(column(kPlane1 - kN1x), bits(at.plane)), hn::Ne(f, set(0)));
    m.k = hn::Add(m.k, hn::IfThenElseZero(counts, hn::CopySign(set(1), f)));
    const M open = hn::Le(hn::Abs(f), column(kE1 - kN1x));
    m.open = hn::Or(m.open, hn::AndNot(same_bits(column(kPlane1 - kN1x), bits(at.plane)), open));
  }
  return m;
}

template <typename Counter>
class SampleScatter {
 public:
  SampleScatter(const ScatterInput& in, Scratch& scratch, const Changes<Counter>& changes)
      : in_(in), s_(scratch), changes_(changes) {}

  /// Whether the depth changes anywhere on the light, or something is open.
  bool operator()(const Sample& at) {
    at_ = &at;
    s_.crossing.count = 0;
    s_.crossing.reserve(s_.settled.count);
    for (std::size_t i = 0; i < s_.settled.count; i += hn::Lanes(D())) project(i);
    std::size_t landed = 0;
    bool any = false;
    for (std::size_t i = 0; i < s_.crossing.count; i += hn::Lanes(D())) any |= cross(i, landed);
    for (std::size_t i = 0; i < landed; ++i) {
      Counter& cell = changes_.cells[s_.landing[i]];
      cell = static_cast<Counter>(cell + s_.jump[i]);
    }
    for (std::size_t i = 0; i < s_.unsettled.count; i += hn::Lanes(D())) any |= unsettled(i);
    return any || landed > 0 || any_precise_ || s_.open.any();
  }

 private:
  void precisely(std::size_t edge, float k, bool open, bool is_settled, bool adds) {
    const float turned = in_.frame.side < 0 ? -k : k;  // seen from behind, counter-clockwise is clockwise
    scatter_precisely<Counter>({in_.frame, *at_, in_.edges, edge, turned, open, is_settled}, adds ? &changes_ : nullptr,
                               s_.open);
    any_precise_ |= adds;
  }
  /// Edges of the group that are not for vectors.
  void precisely(const GroupTable& table, std::size_t i, M which, const Multiplicity& m, bool is_settled) {
    HWY_ALIGN float k[hn::MaxLanes(D())];
    std::uint8_t chosen[8] = {}, open[8] = {};
    hn::Store(m.k, D(), k);
    hn::StoreMaskBits(D(), which, chosen);
    hn::StoreMaskBits(D(), m.open, open);
    for (std::size_t lane = 0; lane < hn::Lanes(D()); ++lane) {
      if ((chosen[lane / 8] >> (lane % 8) & 1) == 0) continue;
      precisely(std::bit_cast<std::uint32_t>(table[kGroupEdge][i + lane]), k[lane],
                (open[lane / 8] >> (lane % 8) & 1) != 0, is_settled, true);
    }
  }

  bool unsettled(std::size_t i) {
    const GroupTable& table = s_.unsettled;
    const Multiplicity m = multiplicity(table, *at_, i);
    const M which = hn::And(first_lanes(table.count - i), hn::Or(m.open, hn::Ne(m.k, set(0))));
    if (hn::AllFalse(D(), which)) return false;
    precisely(table, i, which, m, false);
    return true;
  }

  /// Keeps what crosses light rows or the light's left side.
  void project(std::size_t i) {
    const D d;
    const GroupTable& table = s_.settled;
    const Multiplicity m = multiplicity(table, *at_, i);
    const M live = hn::And(first_lanes(table.count - i), hn::Or(m.open, hn::Ne(m.k, set(0))));
    if (hn::AllFalse(d, live)) return;
    const M open = hn::And(live, m.open);
    if (!hn::AllFalse(d, open)) precisely(table, i, open, m, true);
    const auto column = [&](std::size_t field) { return hn::Load(d, table[field] + i); };
    const Sample& at = *at_;
    const V height = set(at.height), level = set(at.seen.z);
    const V qa = hn::Div(height, hn::Sub(level, column(kAh))), qb = hn::Div(height, hn::Sub(level, column(kBh)));
    const V x0 = hn::Add(set(at.foot.x), hn::Mul(qa, hn::Sub(column(kAx), set(at.seen.x))));
    const V y0 = hn::Add(set(at.foot.y), hn::Mul(qa, hn::Sub(column(kAy), set(at.seen.y))));
    const V x1 = hn::Add(set(at.foot.x), hn::Mul(qb, hn::Sub(column(kBx), set(at.seen.x))));
    const V y1 = hn::Add(set(at.foot.y), hn::Mul(qb, hn::Sub(column(kBy), set(at.seen.y))));
    const V error = column(kGroupError);
    const V low_x = hn::Sub(hn::Min(x0, x1), error), high_x = hn::Add(hn::Max(x0, x1), error);
    const V low_y = hn::Sub(hn::Min(y0, y1), error), high_y = hn::Add(hn::Max(y0, y1), error);
    const V first = hn::Max(hn::Ceil(low_y), set(0));
    const V last = hn::Min(hn::Floor(high_y), set(static_cast<float>(in_.frame.rows) - 1));
    const M left = hn::And(hn::Lt(low_x, set(-0.5F)),
                           hn::And(hn::Ge(high_y, set(-0.5F)), hn::Le(low_y, set(static_cast<float>(in_.frame.rows)))));
    const M before =
        hn::And(hn::Le(low_x, set(static_cast<float>(in_.frame.columns) - 0.5F)), hn::Ge(high_x, set(-0.5F)));
    const M kept = hn::AndNot(open, hn::And(live, hn::And(before, hn::Or(left, hn::Le(first, last)))));
    const std::size_t more = hn::CountTrue(d, kept);
    if (more == 0) return;
    CrossingTable& out = s_.crossing;
    const auto put = [&](std::size_t field, V v) { hn::CompressStore(v, kept, d, out[field] + out.count); };
    put(kX0, x0);
    put(kY0, y0);
    put(kX1, x1);
    put(kY1, y1);
    put(kK, m.k);
    put(kError, error);
    put(kEdge, column(kGroupEdge));
    out.count += more;
  }

  /// Scatters crossing edges; returns whether the left side changes.
  bool cross(std::size_t i, std::size_t& landed) {
    const D d;
    const I di;
    const Frame& frame = in_.frame;
    const CrossingTable& table = s_.crossing;
    const M used = first_lanes(table.count - i);
    const auto column_of = [&](std::size_t field) { return hn::Load(d, table[field] + i); };
    const V x0 = column_of(kX0), y0 = column_of(kY0), x1 = column_of(kX1), y1 = column_of(kY1);
    const V k = frame.side < 0 ? hn::Neg(column_of(kK)) : column_of(kK), error = column_of(kError);
    const V to_a =
        hn::Add(hn::Abs(hn::Sub(x0, set(frame.first_cell.x))), hn::Abs(hn::Sub(y0, set(frame.first_cell.y))));
    const V to_b =
        hn::Add(hn::Abs(hn::Sub(x1, set(frame.first_cell.x))), hn::Abs(hn::Sub(y1, set(frame.first_cell.y))));
    const M turn = hn::Lt(to_b, to_a);
    const V near_x = hn::IfThenElse(turn, x1, x0), near_y = hn::IfThenElse(turn, y1, y0);
    const V far_x = hn::IfThenElse(turn, x0, x1), far_y = hn::IfThenElse(turn, y0, y1);
    const V low_x = hn::Min(x0, x1), high_x = hn::Max(x0, x1), low_y = hn::Min(y0, y1), high_y = hn::Max(y0, y1);
    const V way_x = hn::Sub(far_x, near_x), way_y = hn::Sub(far_y, near_y);
    const M flat = hn::Eq(way_y, set(0));
    const V slope = hn::Div(way_x, way_y), steep = hn::IfThenElse(flat, set(1e30F), hn::Abs(slope));
    const V jump = hn::IfThenElse(hn::Xor(hn::Lt(near_y, far_y), turn), hn::Neg(k), k);
    const V rows = set(static_cast<float>(frame.rows)), columns = set(static_cast<float>(frame.columns));

    // Coarse: whatever may be open by the group's bound is looked at again, precisely.
    M open = hn::Lt(hn::Abs(hn::Sub(near_y, hn::Round(near_y))), error);
    open = hn::Or(open, hn::Lt(hn::Abs(hn::Sub(far_y, hn::Round(far_y))), error));
    const V error_x = hn::MulAdd(hn::Mul(set(2.41F), error), hn::Add(set(1), steep),
                                 hn::Mul(set(8.1F * kRound), hn::Add(set(frame.half_cells.x), hn::Abs(near_x))));
    V row = hn::Min(hn::Max(hn::Ceil(low_y), set(0)), rows);
    const V end = hn::Min(hn::Max(hn::Ceil(high_y), set(0)), rows);
    const V stride = set(static_cast<float>(frame.padded_rows));
    for (;;) {
      const M crossed = hn::And(used, hn::Lt(row, end));
      if (hn::AllFalse(d, crossed)) break;
      const V x = hn::Min(hn::Max(hn::Add(near_x, hn::Mul(hn::Sub(row, near_y), slope)), low_x), high_x);
      const auto number = hn::ConvertTo(di, hn::IfThenElseZero(crossed, row));
      const V column = hn::Sub(x, hn::GatherIndex(d, frame.shift.data(), number));
      const V nearest = hn::Round(column), first = hn::Max(hn::Ceil(column), set(0));
      const M lands = hn::And(crossed, hn::And(hn::Ge(x, set(-0.5F)), hn::Lt(first, columns)));
      const auto place = hn::ConvertTo(di, hn::IfThenElseZero(lands, hn::Add(hn::Mul(first, stride), row)));
      hn::CompressStore(place, hn::RebindMask(di, lands), di, s_.landing.data() + landed);
      hn::CompressStore(hn::ConvertTo(di, jump), hn::RebindMask(di, lands), di, s_.jump.data() + landed);
      landed += hn::CountTrue(d, lands);
      const M near_column = hn::And(hn::Lt(hn::Abs(hn::Sub(column, nearest)), error_x),
                                    hn::And(hn::Ge(nearest, set(0)), hn::Lt(nearest, columns)));
      open = hn::Or(open, hn::And(crossed, hn::Or(near_column, hn::Lt(hn::Abs(hn::Add(x, set(0.5F))), error_x))));
      row = hn::Add(row, set(1));
      if (landed + hn::Lanes(d) > s_.landing.size()) grow_landing();
    }

    const M left = hn::And(used, hn::Xor(hn::Lt(x0, set(-0.5F)), hn::Lt(x1, set(-0.5F))));
    const bool any_left = !hn::AllFalse(d, left);
    if (any_left) {
      const V inverse = hn::Div(way_y, way_x);
      const V y = hn::Min(hn::Max(hn::Add(near_y, hn::Mul(hn::Sub(set(-0.5F), near_x), inverse)), low_y), high_y);
      const V error_y = hn::MulAdd(hn::Mul(set(2.41F), error), hn::Add(set(1), hn::Abs(inverse)),
                                   hn::Mul(set(8.1F * kRound), hn::Add(set(frame.half_cells.y), hn::Abs(near_y))));
      const M at_row = hn::Lt(hn::Abs(hn::Sub(y, hn::Round(y))), error_y);
      open = hn::Or(open, hn::And(left, hn::Or(at_row, hn::Lt(hn::Abs(hn::Add(y, set(0.5F))), error_y))));
      const M above = hn::And(left, hn::And(hn::Gt(y, set(-0.5F)), hn::Le(y, hn::Sub(rows, set(1)))));
      const V up = hn::IfThenElse(hn::Lt(x0, x1), k, hn::Neg(k));
      change_left(hn::Max(hn::Ceil(y), set(0)), up, above);
    }
    open = hn::And(open, used);
    if (!hn::AllFalse(d, open)) look_again(i, open);
    return any_left;
  }

  void grow_landing() {
    s_.landing.resize(2 * s_.landing.size());
    s_.jump.resize(s_.landing.size());
  }

  void change_left(V row, V up, M which) {
    HWY_ALIGN float rows[hn::MaxLanes(D())];
    HWY_ALIGN float ups[hn::MaxLanes(D())];
    const std::size_t count = hn::CompressStore(row, which, D(), rows);
    hn::CompressStore(up, which, D(), ups);
    for (std::size_t lane = 0; lane < count; ++lane) {
      Counter& cell = changes_.left[static_cast<std::size_t>(rows[lane])];
      cell = static_cast<Counter>(cell + static_cast<Counter>(ups[lane]));
    }
  }

  void look_again(std::size_t i, M which) {
    std::uint8_t chosen[8] = {};
    hn::StoreMaskBits(D(), which, chosen);
    for (std::size_t lane = 0; lane < hn::Lanes(D()); ++lane) {
      if ((chosen[lane / 8] >> (lane % 8) & 1) == 0) continue;
      precisely(std::bit_cast<std::uint32_t>(s_.crossing[kEdge][i + lane]), s_.crossing[kK][i + lane], false, true,
                false);
    }
  }

  const ScatterInput& in_;
  Scratch& s_;
  const Changes<Counter>& changes_;
  const Sample* at_ = nullptr;
  bool any_precise_ = false;
};

/// How many triangles the segment from p to the light's lower left corner meets (Woop et al. 2013: in coordinates with
/// the ray as third axis, what decides is three products in two dimensions). One is as good as many where no edge
/// changes the count (`one_will_do`). (bound corner)
std::uint32_t count_to_corner(const ScatterInput& in, const Sample& at, bool one_will_do, Open& open) {
  const D d;
  const TriangleTable& table = in.triangles;
  const glm::vec2 lean = (glm::vec2(-0.5F) - at.foot) / at.height;  // the ray's way in cells for a unit of height
  const float lengths = at.away / at.height, size_of_lean = std::sqrt(lean.x * lean.x + lean.y * lean.y);
  const float per_far = kRound * (8 * in.frame.per_length * (1 + lengths) + (16 + 8 * lengths) * size_of_lean);
  std::uint32_t met = 0;
  for (std::size_t i = 0; i < table.count && !(one_will_do && met > 0); i += hn::Lanes(d)) {
    const auto column = [&](std::size_t field) { return hn::Load(d, table[field] + i); };
    struct Corner {
      V x, y, w;
    };
    const auto corner = [&](std::size_t first) {
      const V w = hn::Sub(set(at.seen.z), column(first + 2));
      return Corner{hn::Sub(hn::Sub(column(first), set(at.seen.x)), hn::Mul(set(lean.x), w)),
                    hn::Sub(hn::Sub(column(first + 1), set(at.seen.y)), hn::Mul(set(lean.y), w)), w};
    };
    const Corner a = corner(kCornerA), b = corner(kCornerB), c = corner(kCornerC);
    const auto cross = [&](const Corner& p, const Corner& q) { return hn::Sub(hn::Mul(p.x, q.y), hn::Mul(p.y, q.x)); };
    const V fab = cross(a, b), fbc = cross(b, c), fca = cross(c, a);
    const V far = hn::Add(column(kTriangleFar), set(at.far));
    const V error_x = hn::Mul(set(per_far), far);
    const auto size1 = [&](const Corner& p) { return hn::Add(hn::Abs(p.x), hn::Abs(p.y)); };
    const V size = hn::Max(size1(a), hn::Max(size1(b), size1(c)));
    const V twice = hn::Add(error_x, error_x);
    const V error = hn::MulAdd(hn::MulAdd(set(4 * kRound), size, twice), size, hn::Mul(twice, error_x));
    const V most = hn::Max(fab, hn::Max(fbc, fca)), least = hn::Min(fab, hn::Min(fbc, fca)), below = hn::Neg(error);
    const M sided = hn::Or(hn::Gt(least, error), hn::Lt(most, below));
    const M passes = hn::And(hn::Gt(most, error), hn::Lt(least, below));
    const V w_most = hn::Max(a.w, hn::Max(b.w, c.w)), w_least = hn::Min(a.w, hn::Min(b.w, c.w));
    // The height over p at which the line meets the triangle's plane: a mean of the corners', with weights f.
    const V total = hn::Add(fab, hn::Add(fbc, fca));
    const V meeting = hn::Div(hn::Add(hn::Mul(fbc, a.w), hn::Add(hn::Mul(fca, b.w), hn::Mul(fab, c.w))), total);
    const V near_p = hn::Mul(set(16 * kRound), far),
            near_light = hn::Mul(set(16 * kRound), hn::Add(far, set(in.frame.reach)));
    const V error_w =
        hn::Add(near_light, hn::Div(hn::Mul(set(6), hn::Mul(error, far)), hn::Max(hn::Abs(total), set(1e-30F))));
    const V height = set(at.height);
    const M within = hn::Or(hn::And(hn::Gt(meeting, error_w), hn::Lt(meeting, hn::Sub(height, error_w))),
                            hn::And(hn::Gt(w_least, near_p), hn::Lt(w_most, hn::Sub(height, near_light))));
    const M outside = hn::Or(
        hn::Or(passes, hn::Lt(w_most, hn::Neg(near_p))),
        hn::Or(hn::Gt(w_least, hn::Add(height, near_light)),
               hn::And(sided, hn::Or(hn::Lt(meeting, hn::Neg(error_w)), hn::Gt(meeting, hn::Add(height, error_w))))));
    const M asked =
        hn::AndNot(hn::Or(outside, same_bits(column(kTrianglePlane), bits(at.plane))), first_lanes(table.count - i));
    const M hit = hn::And(asked, hn::And(sided, within));
    met += static_cast<std::uint32_t>(hn::CountTrue(d, hit));
    if (!hn::AllFalse(d, hn::AndNot(hit, asked))) open.pixel = true;
  }
  return met;
}

// ---- depths to bits ------------------------------------------------------------------------------------------------

template <typename Counter>
using CounterTag = hn::CappedTag<Counter, 16>;

std::uint32_t count_bits(const std::uint16_t* mask, std::size_t words) {
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < words; ++i) count += static_cast<std::uint32_t>(std::popcount(mask[i]));
  return count;
}

/// Depths from changes; a light sample is visible where no triangle is before it.
template <typename Counter>
void sum_up(const Frame& frame, const Changes<Counter>& changes, std::uint32_t depth_at_corner, Seen& seen) {
  const CounterTag<Counter> d;
  std::int32_t depth = static_cast<std::int32_t>(depth_at_corner);
  for (std::uint32_t row = 0; row < frame.padded_rows; ++row) {  // left becomes the depth at the light's left side
    depth += changes.left[row];
    changes.left[row] = row < frame.rows ? static_cast<Counter>(depth) : Counter{1};
  }
  const std::size_t words = frame.padded_rows / 16;
  for (std::size_t row = 0; row < frame.padded_rows; row += hn::Lanes(d)) {
    auto depths = hn::LoadU(d, changes.left + row);
    for (std::size_t column = 0; column < frame.columns; ++column) {
      depths = hn::Add(depths, hn::LoadU(d, changes.cells + column * frame.padded_rows + row));
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(d, hn::Eq(depths, hn::Zero(d)), bytes);
      auto* to = reinterpret_cast<std::uint8_t*>(seen.mask + column * words) + row / 8;
      if (hn::Lanes(d) >= 16) {
        std::memcpy(to, bytes, 2);
      } else if (hn::Lanes(d) == 8) {
        *to = bytes[0];
      } else {  // 4: halves of a byte
        *to = row % 8 == 0 ? bytes[0] : static_cast<std::uint8_t>(*to | bytes[0] << 4);
      }
    }
  }
  seen.visible = count_bits(seen.mask, frame.columns * words);
}

/// Light samples that are not strictly above the carrier's plane are not visible. (bound horizon)
void cut_at_horizon(const Frame& frame, const Sample& at, Open& open, Seen& seen) {
  const std::size_t words = frame.padded_rows / 16;
  for (std::uint32_t column = 0; column < frame.columns; ++column) {
    for (std::uint32_t row = 0; row < frame.rows; ++row) {
      const float s = (static_cast<float>(column) + frame.shift[row] - frame.first_cell.x) / frame.half_cells.x;
      const float t = (static_cast<float>(row) - frame.first_cell.y) / frame.half_cells.y;
      const float value = at.above.x * s + at.above.y * t + at.above.z;
      if (value > at.above_error) continue;
      std::uint16_t& word = seen.mask[column * words + row / 16];
      word = static_cast<std::uint16_t>(word & ~(1U << row % 16));
      if (value >= -at.above_error) open.samples.push_back(row * frame.columns + column);
    }
  }
  seen.visible = count_bits(seen.mask, frame.columns * words);
}

void fill(const Frame& frame, bool visible, Seen& seen) {
  const std::size_t words = frame.padded_rows / 16;
  for (std::size_t i = 0; i < frame.columns * words; ++i) {
    const std::size_t first = i % words * 16,
                      rows = std::min<std::size_t>(frame.rows - std::min<std::size_t>(first, frame.rows), 16);
    seen.mask[i] = visible ? static_cast<std::uint16_t>((1U << rows) - 1) : std::uint16_t{0};
  }
  seen.visible = visible ? frame.rows * frame.columns : 0;
}

/// One view sample, its group's edges sorted out.
template <typename Counter>
void scatter_sample(const ScatterInput& in, Scratch& scratch, std::vector<Counter>& histogram,
                    std::vector<Counter>& left, const Sample& at, Seen& seen) {
  const Frame& frame = in.frame;
  const bool edges = scratch.settled.count + scratch.unsettled.count > 0;
  const std::uint32_t depth = count_to_corner(in, at, !edges, scratch.open);
  bool changes_any = false;
  if (edges) {
    histogram.assign(std::size_t{frame.columns} * frame.padded_rows, 0);
    left.assign(frame.padded_rows, 0);
    const Changes<Counter> changes{histogram.data(), left.data()};
    changes_any = SampleScatter<Counter>(in, scratch, changes)(at);
    if (changes_any) sum_up(frame, changes, depth, seen);
  }
  if (!changes_any) {
    seen.visible = depth == 0 ? frame.rows * frame.columns : 0;
    if (at.straddles || scratch.open.any()) fill(frame, depth == 0, seen);
  }
  if (at.straddles) cut_at_horizon(frame, at, scratch.open, seen);
}

void scatter_here(const ScatterInput& in, Scratch& scratch, Judge& judge, std::span<Seen> seen) {
  const Frame& frame = in.frame;
  const std::span<const Sample> samples(in.cluster.samples);
  const glm::vec3 from_light = in.cluster.middle - frame.center;
  const glm::vec2 foot =
      glm::vec2(glm::dot(frame.across, from_light), glm::dot(frame.along, from_light)) + frame.first_cell;
  const float height = glm::dot(frame.axis, from_light);
  if (scratch.landing.empty()) {
    scratch.landing.resize(4096);
    scratch.jump.resize(4096);
  }
  for (std::size_t first = 0; first < samples.size(); first += kGroup) {
    const auto group = samples.subspan(first, std::min(kGroup, samples.size() - first));
    const GroupBounds bounds = bounds_of(group);
    GroupFilter(in, bounds, foot, height)(scratch.settled, scratch.unsettled);
    // Changes of a cell and its depth stay within ±(2 edges + triangles).
    const bool narrow = 2 * (scratch.settled.count + scratch.unsettled.count) + in.triangles.count < 32000;
    for (std::size_t i = 0; i < group.size(); ++i) {
      scratch.open.clear();
      Seen& result = seen[first + i];
      if (narrow) {
        scatter_sample(in, scratch, scratch.histogram, scratch.left, group[i], result);
      } else {
        scatter_sample(in, scratch, scratch.wide_histogram, scratch.wide_left, group[i], result);
      }
      if (scratch.open.any()) judge.decide(group[i], scratch.open, result);
    }
  }
}

}  // namespace
}  // namespace penumbra::volumes::native::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::volumes::native {

HWY_EXPORT(scatter_here);

void scatter(const ScatterInput& input, Scratch& scratch, Judge& judge, std::span<Seen> seen) {
  HWY_DYNAMIC_DISPATCH(scatter_here)(input, scratch, judge, seen);
}

}  // namespace penumbra::volumes::native
#endif
