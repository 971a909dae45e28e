// SPDX-License-Identifier: Apache-2.0
// View-sample mapping on a processor: tests a vector of triangles against one view sample, and finds the spans of light
// columns that the triangles cover, row by row (scan conversion). Cases that float arithmetic cannot decide go to
// test_carefully. The paper and our departures are on docs/view-sample.md.

#include "vsm/vectors/pairs.hpp"

#include "engines/vectors/horizon.hpp"

#include <algorithm>
#include <array>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vsm/vectors/pairs.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "engines/vectors/pack-inl.hpp"
#include "engines/vectors/vectors-inl.hpp"
#include "vsm/vectors/project-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace penumbra::vsm::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vectors::HWY_NAMESPACE;

class SampleTest {
 public:
  SampleTest(const PairInput& in, PairScratch& scratch, const ClusterSample& at)
      : in_(in), s_(scratch), at_(at), project_(in, scratch, at) {}

  /// Returns whether anything is hidden or open. Stops when all light samples are hidden.
  bool operator()() {
    const std::uint32_t all = in_.grid.rows * in_.grid.columns;
    bool any = false;
    s_.survivors.reserve(kChunk + hn::Lanes(D()));
    for (std::size_t begin = 0; begin < s_.near.count; begin += kChunk) {
      const std::size_t end = std::min(begin + kChunk, s_.near.count);
      s_.again.clear();
      s_.asked.clear();
      s_.survivors.count = 0;
      for (std::size_t i = begin; i < end; i += hn::Lanes(D())) project_(i, end);
      std::size_t landed = 0;
      for (std::size_t i = 0; i < s_.survivors.count; i += hn::Lanes(D())) landed = convert(i, landed);
      for (std::size_t i = 0; i < landed; ++i) {
        const auto from = static_cast<std::uint32_t>(s_.row_and_from[i]);
        s_.blocked.add(from / kRowUnit, from % kRowUnit, static_cast<std::uint32_t>(s_.to[i]));
      }
      for (const std::uint32_t i : s_.again) {
        test_carefully({in_, at_, std::bit_cast<std::uint32_t>(s_.near[kTriangleSlot][i])}, s_.blocked, s_.open);
      }
      for (const auto& [i, row, column] : s_.asked) {
        test_one({in_, at_, std::bit_cast<std::uint32_t>(s_.near[kTriangleSlot][i])}, row, column, s_.blocked, s_.open);
      }
      s_.pairs += end - begin;
      s_.careful += s_.again.size();
      any |= landed + s_.again.size() + s_.asked.size() > 0;
      if (landed + s_.again.size() > 0 && s_.blocked.count() == all) break;
    }
    return any;
  }

 private:
  static constexpr std::uint32_t kRowUnit = 4096;  // larger than the number of columns

  struct LightPoints {
    V x, y;
  };
  static void order(LightPoints& a, LightPoints& b) {
    const M turn = hn::Gt(a.y, b.y);
    const LightPoints upper{hn::IfThenElse(turn, a.x, b.x), hn::Max(a.y, b.y)};
    a = {hn::IfThenElse(turn, b.x, a.x), hn::Min(a.y, b.y)};
    b = upper;
  }

  /// Records light samples within the error of an edge as open.
  void ask(M which, std::size_t i, V row, V column) {
    which = hn::And(which, hn::And(hn::Ge(column, set(0)), hn::Lt(column, set(static_cast<float>(in_.grid.columns)))));
    HWY_ALIGN float rows[hn::MaxLanes(D())];
    HWY_ALIGN float columns[hn::MaxLanes(D())];
    hn::Store(row, D(), rows);
    hn::Store(column, D(), columns);
    for_each_lane(which, [&](std::size_t lane) {
      s_.asked.push_back({std::bit_cast<std::uint32_t>(s_.survivors[kTriangle][i + lane]),
                          static_cast<std::uint32_t>(rows[lane]), static_cast<std::uint32_t>(columns[lane])});
    });
  }

  /// Finds spans of columns that triangles cover: in each row, between the two edges that cross the row. (bound span)
  std::size_t convert(std::size_t i, std::size_t landed) {
    const D d;
    const I di;
    const LightGrid& grid = in_.grid;
    const SurvivorTable& table = s_.survivors;
    const auto column_of = [&](std::size_t field) { return hn::Load(d, table[field] + i); };
    LightPoints a{column_of(kX0), column_of(kY0)}, b{column_of(kX1), column_of(kY1)}, c{column_of(kX2), column_of(kY2)};
    order(a, b);
    order(b, c);
    order(a, b);
    const V error = column_of(kError), zero = set(0), columns = set(static_cast<float>(grid.columns)),
            last_row = set(static_cast<float>(grid.rows) - 1);
    const auto near_row = [&](V y) {
      const V row = hn::Round(y);
      return hn::And(hn::Le(hn::Abs(hn::Sub(y, row)), error), hn::And(hn::Ge(row, zero), hn::Le(row, last_row)));
    };
    const M used = first_lanes(table.count - i);
    M open = hn::Or(hn::Or(near_row(a.y), near_row(b.y)), hn::Or(near_row(c.y), hn::Gt(error, set(0.25F))));
    const V to_b = hn::Div(hn::Sub(b.x, a.x), hn::Sub(b.y, a.y)), to_c = hn::Div(hn::Sub(c.x, a.x), hn::Sub(c.y, a.y)),
            b_to_c = hn::Div(hn::Sub(c.x, b.x), hn::Sub(c.y, b.y));
    const V largest = hn::Max(hn::Abs(a.x), hn::Max(hn::Abs(b.x), hn::Abs(c.x)));
    const V rounding = hn::MulAdd(set(1.2F), error, hn::Mul(set(16 * kRound), hn::Add(largest, columns)));
    const V per_slope = hn::Mul(set(1.2F), error);
    const V slack_long = hn::MulAdd(per_slope, hn::Abs(to_c), rounding);
    V row = hn::Max(hn::Ceil(a.y), zero);
    const V end = hn::Min(hn::Floor(c.y), last_row);
    const M settled = hn::AndNot(open, used);
    for (;;) {
      const M active = hn::And(settled, hn::Le(row, end));
      if (hn::AllFalse(d, active)) break;
      const M low = hn::Lt(row, b.y);
      const V slope = hn::IfThenElse(low, to_b, b_to_c), from_x = hn::IfThenElse(low, a.x, c.x),
              from_y = hn::IfThenElse(low, a.y, c.y);
      const V shift = hn::GatherIndex(d, grid.shift.data(), hn::ConvertTo(di, hn::IfThenElseZero(active, row)));
      const V x = hn::Sub(hn::MulAdd(hn::Sub(row, a.y), to_c, a.x), shift),
              y = hn::Sub(hn::MulAdd(hn::Sub(row, from_y), slope, from_x), shift);
      const V slack = hn::Max(slack_long, hn::MulAdd(per_slope, hn::Abs(slope), rounding));
      const V low_x = hn::Min(x, y), high_x = hn::Max(x, y), low_k = hn::Round(low_x), high_k = hn::Round(high_x);
      const M wide = hn::And(active, hn::Gt(slack, set(0.25F))), narrow = hn::AndNot(wide, active);
      open = hn::Or(open, wide);
      const M low_near = hn::Le(hn::Abs(hn::Sub(low_x, low_k)), slack),
              high_near = hn::Le(hn::Abs(hn::Sub(high_x, high_k)), slack);
      const M near = hn::And(narrow, hn::Or(low_near, high_near));
      if (!hn::AllFalse(d, near)) {
        ask(hn::And(near, low_near), i, row, low_k);
        ask(hn::And(near, high_near), i, row, high_k);
      }
      const V one = set(1), from = hn::Max(hn::IfThenElse(low_near, hn::Add(low_k, one), hn::Ceil(low_x)), zero);
      const V to = hn::Min(hn::IfThenElse(high_near, hn::Sub(high_k, one), hn::Floor(high_x)), hn::Sub(columns, one));
      const M lands = hn::And(narrow, hn::Le(from, to));
      const auto lands_i = hn::RebindMask(di, lands);
      pack(hn::ConvertTo(di, hn::IfThenElseZero(lands, hn::MulAdd(row, set(kRowUnit), from))), lands_i, di,
           s_.row_and_from.data() + landed);
      pack(hn::ConvertTo(di, hn::IfThenElseZero(lands, to)), lands_i, di, s_.to.data() + landed);
      landed += hn::CountTrue(d, lands);
      if (landed + hn::Lanes(d) > s_.to.size()) {
        s_.to.resize(2 * s_.to.size());
        s_.row_and_from.resize(s_.to.size());
      }
      row = hn::Add(row, set(1));
    }
    open = hn::And(open, used);
    if (!hn::AllFalse(d, open)) project_.look_again(open, column_of(kTriangle));
    return landed;
  }

  const PairInput& in_;
  PairScratch& s_;
  const ClusterSample& at_;
  Projection project_;
};

/// Transposes blocked light samples, stored row by row, into the mask, which is stored column by column.
void write_mask(const LightGrid& grid, Blocked& blocked, SampleMask& mask) {
  const hn::CappedTag<std::uint16_t, 16> d;
  fill(grid, true, mask);
  HWY_ALIGN std::uint16_t rows[16];
  for (std::uint32_t row = 0; row < grid.rows; row += 16) {
    for (std::uint32_t column = 0; column < grid.columns; column += 16) {
      for (std::uint32_t i = 0; i < 16; ++i) {
        const bool there = row + i < grid.rows;
        rows[i] =
            there ? static_cast<std::uint16_t>(blocked.row(row + i)[column / 64] >> column % 64) : std::uint16_t{0};
      }
      for (std::uint32_t bit = 0; bit < 16 && column + bit < grid.columns; ++bit) {
        const auto which = hn::Set(d, static_cast<std::uint16_t>(1U << bit));
        std::uint32_t hidden = 0;
        for (std::size_t i = 0; i < 16; i += hn::Lanes(d)) {
          std::uint8_t bytes[8] = {};
          hn::StoreMaskBits(d, hn::TestBit(hn::Load(d, rows + i), which), bytes);
          hidden |= (bytes[0] | std::uint32_t{bytes[1]} << 8U) << i;
        }
        std::uint16_t& word = mask.bits[((column + bit) * grid.padded_rows + row) / 16];
        word = static_cast<std::uint16_t>(word & ~hidden);
      }
    }
  }
  mask.visible = grid.rows * grid.columns - blocked.count();
}

void test_sample(const PairInput& in, PairScratch& scratch, const ClusterSample& at, OpenJudge& judge,
                 SampleMask& mask) {
  const LightGrid& grid = in.grid;
  scratch.open.clear();
  scratch.blocked.reset(grid.rows, grid.columns);
  if (!SampleTest(in, scratch, at)()) {
    scratch.open.clear();
    see_all(grid, at, scratch.open, judge, mask);
    return;
  }
  mask.visible = grid.rows * grid.columns - scratch.blocked.count();
  if (mask.visible == 0) return;
  std::erase_if(scratch.open.samples, [&](std::uint32_t light_sample) {
    return scratch.blocked.test(light_sample / grid.columns, light_sample % grid.columns);
  });
  write_mask(grid, scratch.blocked, mask);
  if (at.straddles) cut_at_horizon(grid, at, scratch.open, mask);
  if (scratch.open.any()) judge.decide(at, scratch.open, mask);
}

void test_pairs_here(const PairInput& in, PairScratch& scratch, OpenJudge& judge, std::span<SampleMask> masks) {
  if (scratch.to.empty()) {
    scratch.to.resize(4096);
    scratch.row_and_from.resize(4096);
  }
  for_each_in_groups(in, scratch, [&](std::size_t i) { test_sample(in, scratch, in.samples[i], judge, masks[i]); });
}

}  // namespace
}  // namespace penumbra::vsm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::vsm {

HWY_EXPORT(test_pairs_here);

void test_pairs(const PairInput& input, PairScratch& scratch, OpenJudge& judge, std::span<SampleMask> masks) {
  HWY_DYNAMIC_DISPATCH(test_pairs_here)(input, scratch, judge, masks);
}

}  // namespace penumbra::vsm
#endif
