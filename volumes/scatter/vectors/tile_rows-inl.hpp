// SPDX-License-Identifier: Apache-2.0
// Finds the rows of tiles of light samples that a vector of edges is in (points.cpp). Included once for each target,
// after foreach_target.h.

#if defined(PENUMBRA_VOLUMES_TILE_ROWS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_VOLUMES_TILE_ROWS_INL_HPP
#undef PENUMBRA_VOLUMES_TILE_ROWS_INL_HPP
#else
#define PENUMBRA_VOLUMES_TILE_ROWS_INL_HPP
#endif

#include "engines/vectors/pack-inl.hpp"
#include "volumes/scatter/vectors/upward-inl.hpp"

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace penumbra::volumes::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vectors::HWY_NAMESPACE;

/// Rows of tiles that a few edges are in: each entry is a row and an edge.
struct EdgesInRows {
  static constexpr std::int32_t kEdges = 0xff, kCrosses = 0x100;  // kCrosses: the edge crosses the row's path
  static constexpr int kRowShift = 9;
  static constexpr std::size_t kMost = (LightTiles::kMostRows + 1) * hn::MaxLanes(D());
  HWY_ALIGN std::array<std::int32_t, kMost> where;  // the edge, kCrosses, and the row
  HWY_ALIGN std::array<std::int32_t, kMost> steps;  // steps (LightTiles::tiles_at) at which the edge begins and ends
                                                    // there: begin + 2¹⁶ · end
  std::size_t count = 0;
};

/// Finds the rows of tiles of a vector of edges, with their extents.
class RowsFinder {
 public:
  explicit RowsFinder(const LightTiles& tiles) : tiles_(tiles) {}

  /// Writes the rows into `out`, replacing its content.
  void operator()(const UpwardVectors& e, EdgesInRows& out) const {
    const I di;
    out.count = 0;
    const auto past = hn::Set(di, static_cast<std::int32_t>(tiles_.rows.size())), one = hn::Set(di, 1);
    M going = e.used;
    for (auto row = e.row;; row = hn::Min(hn::Add(row, one), past)) {
      const V low = of_row(tiles_.row_low, row);
      going = hn::And(going, hn::Le(low, e.top));
      if (hn::AllFalse(D(), going)) return;
      const V high = of_row(tiles_.row_high, row);
      const M here = hn::And(going, hn::Ge(high, e.bottom));
      const V from = hn::Add(e.low_x, hn::Mul(hn::Sub(hn::Max(low, e.bottom), e.low_y), e.slope));
      const V to = hn::Add(e.low_x, hn::Mul(hn::Sub(hn::Min(high, e.top), e.low_y), e.slope));
      const auto left = step_at(hn::Max(e.leftmost, hn::Sub(hn::Min(from, to), e.beside)), here);
      const auto right = step_at(hn::Min(e.rightmost, hn::Add(hn::Max(from, to), e.beside)), here);
      const M crosses = hn::AndNot(hn::Gt(e.low_y, low), hn::Gt(e.high_y, low));
      const auto kept = hn::RebindMask(di, here);
      const auto where = hn::Or(hn::Or(hn::ShiftLeft<EdgesInRows::kRowShift>(row), hn::Iota(di, 0)),
                                hn::IfThenElseZero(hn::RebindMask(di, crosses), hn::Set(di, EdgesInRows::kCrosses)));
      pack(where, kept, di, out.where.data() + out.count);
      out.count += pack(hn::Or(left, hn::ShiftLeft<16>(right)), kept, di, out.steps.data() + out.count);
    }
  }

 private:
  /// Returns a row's value for each lane. There are at most sixteen rows; the index after the last gives a value out of
  /// reach.
  [[nodiscard]] static HWY_INLINE V of_row(const LightTiles::RowFloats& rows, hn::Vec<I> row) {
#if HWY_TARGET <= HWY_AVX3
    return hn::IfThenElse(hn::RebindMask(D(), hn::Lt(row, hn::Set(I(), std::int32_t{LightTiles::kMostRows}))),
                          hn::TableLookupLanes(hn::LoadU(D(), rows.data()), hn::IndicesFromVec(D(), row)), set(3e38F));
#else
    return hn::GatherIndex(D(), rows.data(), row);
#endif
  }
  [[nodiscard]] HWY_INLINE hn::Vec<I> step_at(V x, M used) const {
    const V last = set(static_cast<float>(tiles_.steps - 1));
    const V step = hn::Min(hn::Max(hn::Mul(hn::Add(x, set(0.5F)), set(tiles_.steps_per_cell)), set(0)), last);
    return hn::ConvertTo(I(), hn::IfThenElseZero(used, step));
  }

  const LightTiles& tiles_;
};

}  // namespace
}  // namespace penumbra::volumes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // once for each target
