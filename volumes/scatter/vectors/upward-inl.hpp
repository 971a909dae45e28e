// Edges turned upward, side by side: what light samples anywhere are tested against (points.cpp). Included once a
// target, after foreach_target.h.

#if defined(PENUMBRA_VOLUMES_UPWARD_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_VOLUMES_UPWARD_INL_HPP
#undef PENUMBRA_VOLUMES_UPWARD_INL_HPP
#else
#define PENUMBRA_VOLUMES_UPWARD_INL_HPP
#endif

#include "engines/vectors/light_tiles.hpp"
#include "engines/vectors/vectors-inl.hpp"
#include "volumes/scatter/vectors/scatter.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace penumbra::volumes::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vectors::HWY_NAMESPACE;

/// A few edges as they appear, side by side, each from its lower end to its upper one.
enum UpwardField : std::size_t {
  kLowX,
  kLowY,
  kHighX,
  kHighY,
  kWayX,
  kWayY,
  kJump,       // of the depth to the right of it
  kNear,       // a light sample that is no farther on either side (in areas: side_of) may be on the other one
  kSlope,      // of x
  kBeside,     // along a row: no farther from it are such light samples
  kLeftmost,   // nor are they left of here,
  kRightmost,  // right of here,
  kBottom,     // below
  kTop,        // or above
  kUpwardFields
};
struct UpwardEdges {
  HWY_ALIGN std::array<std::array<float, hn::MaxLanes(D())>, kUpwardFields> fields;
  HWY_ALIGN std::array<std::int32_t, hn::MaxLanes(D())> tile_row;  // of tiles: none below it reaches up to kBottom
  std::size_t first = 0;                                           // in the CrossingTable
};
/// One of them.
struct UpwardEdge {
  const UpwardEdges& edges;
  std::size_t lane;

  [[nodiscard]] float operator[](UpwardField field) const { return edges.fields[field][lane]; }
  [[nodiscard]] std::size_t crossing() const { return edges.first + lane; }
  /// > 0: (x, y) is right of the line through it; twice the area between the three.
  [[nodiscard]] float side_of(float x, float y) const {
    return (x - (*this)[kLowX]) * (*this)[kWayY] - (y - (*this)[kLowY]) * (*this)[kWayX];
  }
};

/// Returns those that the light's corner or left side may have to do with. (bound side of a point)
[[maybe_unused]] M turn_upward(const LightGrid& grid, const CrossingTable& table, std::size_t first, UpwardEdges& out) {
  const D d;
  const auto column = [&](std::size_t field) { return hn::Load(d, table[field] + first); };
  const auto store = [&](UpwardField field, V v) { hn::Store(v, d, out.fields[field].data()); };
  const V x0 = column(kX0), y0 = column(kY0), x1 = column(kX1), y1 = column(kY1);
  const M used = first_lanes(table.count - first), up = hn::Lt(y0, y1);
  const V k = grid.side < 0 ? hn::Neg(column(kK)) : column(kK);  // seen from behind, all turn the other way
  const V low_x = hn::IfThenElse(up, x0, x1), low_y = hn::IfThenElse(up, y0, y1);
  const V high_x = hn::IfThenElse(up, x1, x0), high_y = hn::IfThenElse(up, y1, y0);
  const V way_x = hn::Sub(high_x, low_x), way_y = hn::Sub(high_y, low_y), wide = hn::Abs(way_x);
  const V around = hn::Mul(set(2.41F), column(kError)), rounding = set(16 * kRound);
  out.first = first;
  store(kLowX, low_x);
  store(kLowY, low_y);
  store(kHighX, high_x);
  store(kHighY, high_y);
  store(kWayX, way_x);
  store(kWayY, way_y);
  store(kJump, hn::IfThenElse(up, hn::Neg(k), k));
  store(kNear, hn::MulAdd(around, hn::Add(wide, way_y), hn::Mul(rounding, hn::Mul(wide, way_y))));
  // A flatter one may be beside any light sample of a row: right at every limit, which only keeps slopes finite.
  const M leans = hn::Gt(way_y, hn::Mul(set(1e-6F), wide));
  const V slope = hn::IfThenElseZero(leans, hn::Div(way_x, way_y));
  const V beside =
      hn::MulAdd(around, hn::Add(set(1), hn::Abs(slope)), hn::Mul(rounding, hn::Add(hn::Abs(low_x), wide)));
  store(kSlope, slope);
  store(kBeside, hn::IfThenElse(leans, beside, set(3e38F)));
  store(kLeftmost, hn::Sub(hn::Min(low_x, high_x), around));
  store(kRightmost, hn::Add(hn::Max(low_x, high_x), around));
  const V bottom = hn::Sub(low_y, around);
  store(kBottom, bottom);
  store(kTop, hn::Add(high_y, around));
  const V steps = set(static_cast<float>(grid.tiles->row_from.size() - 1));
  const V step = hn::Min(hn::Max(hn::Mul(hn::Add(bottom, set(0.5F)), set(LightTiles::kStepsPerCell)), set(0)), steps);
  const auto number = hn::ConvertTo(I(), hn::IfThenElseZero(used, step));
  hn::Store(hn::GatherIndex(I(), grid.tiles->row_from.data(), number), I(), out.tile_row.data());
  const M left = hn::Or(hn::Lt(low_x, set(-0.5F)), hn::Lt(high_x, set(-0.5F)));
  return hn::And(used, hn::Or(left, hn::Le(bottom, set(-0.5F))));
}

}  // namespace
}  // namespace penumbra::volumes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // once a target
