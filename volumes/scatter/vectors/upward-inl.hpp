// SPDX-License-Identifier: Apache-2.0
// Edges oriented upward, in vectors: the form in which arbitrary light samples are tested (points.cpp). Included once
// for each target, after foreach_target.h. Bounds: docs/edge-scatter.md.

#if defined(PENUMBRA_VOLUMES_UPWARD_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_VOLUMES_UPWARD_INL_HPP
#undef PENUMBRA_VOLUMES_UPWARD_INL_HPP
#else
#define PENUMBRA_VOLUMES_UPWARD_INL_HPP
#endif

#include "engines/vectors/light_tiles.hpp"
#include "engines/vectors/vectors-inl.hpp"
#include "volumes/edges/vectors/tables.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace penumbra::volumes::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vectors::HWY_NAMESPACE;

/// A few projected edges in vectors, each from its lower end to its upper one.
enum UpwardField : std::size_t {
  kLowX,
  kLowY,
  kHighX,
  kHighY,
  kDeltaX,
  kDeltaY,
  kJump,       // change of the depth to the right of the edge
  kNear,       // a light sample whose |side_of| is at most this may be on the other side of the edge
  kLeftmost,   // no such light sample is left of this,
  kRightmost,  // right of this,
  kBottom,     // below this
  kTop,        // or above this
  kUpwardFields
};
struct UpwardEdges {
  HWY_ALIGN std::array<std::array<float, hn::MaxLanes(D())>, kUpwardFields> fields;
  std::size_t first = 0;  // index of the first edge in the CrossingTable
};
/// Edges in registers, with values that only the search for tiles uses.
struct UpwardVectors {
  V low_x, low_y, high_x, high_y, jump, leftmost, rightmost, bottom, top;
  V slope;         // slope of x
  V beside;        // light samples within this of the edge, along a row, may be on its other side
  hn::Vec<I> row;  // row of tiles at which to begin: no row below it reaches up to `bottom`
  M used;
  M beside_left;  // the edge may affect the light's corner or left side
};
/// One edge of a vector.
struct UpwardEdge {
  const UpwardEdges& edges;
  std::size_t lane;

  [[nodiscard]] float operator[](UpwardField field) const { return edges.fields[field][lane]; }
  [[nodiscard]] std::size_t crossing() const { return edges.first + lane; }
  /// Returns twice the area between the three points: > 0 if (x, y) is right of the line through the edge.
  [[nodiscard]] float side_of(float x, float y) const {
    return (x - (*this)[kLowX]) * (*this)[kDeltaY] - (y - (*this)[kLowY]) * (*this)[kDeltaX];
  }
};

/// Error bounds: (bound side of a point).
[[maybe_unused]] HWY_INLINE UpwardVectors turn_upward(const LightGrid& grid, const CrossingTable& table,
                                                      std::size_t first, UpwardEdges& out) {
  const D d;
  const auto column = [&](std::size_t field) { return hn::Load(d, table[field] + first); };
  const auto store = [&](UpwardField field, V v) { hn::Store(v, d, out.fields[field].data()); };
  const V x0 = column(kX0), y0 = column(kY0), x1 = column(kX1), y1 = column(kY1);
  const M up = hn::Lt(y0, y1);
  const V k = grid.side < 0 ? hn::Neg(column(kK)) : column(kK);  // seen from behind, all orientations are reversed
  UpwardVectors e;
  e.used = first_lanes(table.count - first);
  e.low_x = hn::IfThenElse(up, x0, x1), e.low_y = hn::IfThenElse(up, y0, y1);
  e.high_x = hn::IfThenElse(up, x1, x0), e.high_y = hn::IfThenElse(up, y1, y0);
  e.jump = hn::IfThenElse(up, hn::Neg(k), k);
  const V delta_x = hn::Sub(e.high_x, e.low_x), delta_y = hn::Sub(e.high_y, e.low_y), wide = hn::Abs(delta_x);
  const V around = hn::Mul(set(2.41F), column(kError)), rounding = set(16 * kRound);
  e.leftmost = hn::Sub(hn::Min(e.low_x, e.high_x), around);
  e.rightmost = hn::Add(hn::Max(e.low_x, e.high_x), around);
  e.bottom = hn::Sub(e.low_y, around);
  e.top = hn::Add(e.high_y, around);
  out.first = first;
  store(kLowX, e.low_x);
  store(kLowY, e.low_y);
  store(kHighX, e.high_x);
  store(kHighY, e.high_y);
  store(kDeltaX, delta_x);
  store(kDeltaY, delta_y);
  store(kJump, e.jump);
  store(kNear, hn::MulAdd(around, hn::Add(wide, delta_y), hn::Mul(rounding, hn::Mul(wide, delta_y))));
  store(kLeftmost, e.leftmost);
  store(kRightmost, e.rightmost);
  store(kBottom, e.bottom);
  store(kTop, e.top);
  // A flatter edge may be next to any light sample of a row. Any threshold is correct: it only keeps slopes finite.
  const M leans = hn::Gt(delta_y, hn::Mul(set(1e-6F), wide));
  e.slope = hn::IfThenElseZero(leans, hn::Div(delta_x, delta_y));
  const V beside =
      hn::MulAdd(around, hn::Add(set(1), hn::Abs(e.slope)), hn::Mul(rounding, hn::Add(hn::Abs(e.low_x), wide)));
  e.beside = hn::IfThenElse(leans, beside, set(3e38F));
  const V steps = set(static_cast<float>(grid.tiles->row_from.size() - 1));
  const V step = hn::Min(hn::Max(hn::Mul(hn::Add(e.bottom, set(0.5F)), set(LightTiles::kStepsPerCell)), set(0)), steps);
  const auto number = hn::ConvertTo(I(), hn::IfThenElseZero(e.used, step));
  e.row = hn::GatherIndex(I(), grid.tiles->row_from.data(), number);
  const M left = hn::Or(hn::Lt(e.low_x, set(-0.5F)), hn::Lt(e.high_x, set(-0.5F)));
  e.beside_left = hn::And(e.used, hn::Or(left, hn::Le(e.bottom, set(-0.5F))));
  return e;
}

}  // namespace
}  // namespace penumbra::volumes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // once for each target
