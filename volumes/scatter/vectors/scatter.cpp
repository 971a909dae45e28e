// SPDX-License-Identifier: Apache-2.0
// Edge scatter on a processor: the algorithm of scatter_edges.comp, with vectors of edges instead of view samples.

#include "volumes/scatter/vectors/scatter.hpp"

#include "engines/vectors/horizon.hpp"
#include "volumes/edges/vectors/corner.hpp"
#include "volumes/edges/vectors/precise.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volumes/scatter/vectors/scatter.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "engines/vectors/pack-inl.hpp"
#include "engines/vectors/vectors-inl.hpp"
#include "volumes/edges/vectors/projection-inl.hpp"
#include "volumes/edges/vectors/special-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace penumbra::volumes::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vectors::HWY_NAMESPACE;

/// Projects the group's edges for one view sample. Vectors add most of them; the others are listed to be added singly.
void project(const ClusterInput& in, EdgeScratch& found, RowScratch& scratch, const ClusterSample& at,
             OpenJudge& judge) {
  scratch.precise.clear();
  const auto special = [&](const SpecialEdges& edges) {
    for_each_sure(in, at, edges, judge, found.open, [&](std::uint32_t edge, float k) {
      scratch.precise.push_back({edge, k, edges.settled});
    });
  };
  Projection{in, at, found.lists, found.crossing}(special);
}

/// Adds the changes of projected edges.
template <typename Counter>
class SampleScatter {
 public:
  SampleScatter(const ClusterInput& in, EdgeScratch& found, RowScratch& scratch, const Changes<Counter>& changes,
                const ClusterSample& at)
      : in_(in), f_(found), s_(scratch), changes_(changes), at_(at) {}

  /// Returns whether the depth changes anywhere on the light, or something is open.
  bool operator()() {
    for (const PreciseEdge& one : s_.precise) precisely(one.edge, one.k, one.settled, std::nullopt);
    std::size_t landed = 0;
    bool any = !s_.precise.empty();
    for (std::size_t i = 0; i < f_.crossing.count; i += hn::Lanes(D())) any |= cross(i, landed);
    for (std::size_t i = 0; i < landed; ++i) {
      Counter& cell = changes_.cells[s_.landing[i]];
      cell = static_cast<Counter>(cell + s_.jump[i]);
    }
    return any || landed > 0 || any_looked_at_ || f_.open.any();
  }

 private:
  void precisely(std::size_t edge, float k, bool is_settled, const std::optional<std::array<glm::vec2, 2>>& projected) {
    const float turned = in_.grid.side < 0 ? -k : k;  // seen from behind, counter-clockwise is clockwise
    scatter_precisely<Counter>({in_, at_, edge, turned, is_settled, projected}, changes_, f_.open);
  }

  /// Scatters crossing edges; returns whether the left side changes.
  bool cross(std::size_t i, std::size_t& landed) {
    const D d;
    const I di;
    const LightGrid& grid = in_.grid;
    const CrossingTable& table = f_.crossing;
    const M used = first_lanes(table.count - i);
    const auto column_of = [&](std::size_t field) { return hn::Load(d, table[field] + i); };
    const V x0 = column_of(kX0), y0 = column_of(kY0), x1 = column_of(kX1), y1 = column_of(kY1);
    const V k = grid.side < 0 ? hn::Neg(column_of(kK)) : column_of(kK), error = column_of(kError);
    const V to_a = hn::Add(hn::Abs(hn::Sub(x0, set(grid.first_cell.x))), hn::Abs(hn::Sub(y0, set(grid.first_cell.y))));
    const V to_b = hn::Add(hn::Abs(hn::Sub(x1, set(grid.first_cell.x))), hn::Abs(hn::Sub(y1, set(grid.first_cell.y))));
    const M turn = hn::Lt(to_b, to_a);
    const V near_x = hn::IfThenElse(turn, x1, x0), near_y = hn::IfThenElse(turn, y1, y0);
    const V far_x = hn::IfThenElse(turn, x0, x1), far_y = hn::IfThenElse(turn, y0, y1);
    const V low_x = hn::Min(x0, x1), high_x = hn::Max(x0, x1), low_y = hn::Min(y0, y1), high_y = hn::Max(y0, y1);
    const V delta_x = hn::Sub(far_x, near_x), delta_y = hn::Sub(far_y, near_y);
    const M flat = hn::Eq(delta_y, set(0));
    const V slope = hn::Div(delta_x, delta_y), steep = hn::IfThenElse(flat, set(1e30F), hn::Abs(slope));
    const V jump = hn::IfThenElse(hn::Xor(hn::Lt(near_y, far_y), turn), hn::Neg(k), k);
    const V rows = set(static_cast<float>(grid.rows)), columns = set(static_cast<float>(grid.columns));

    // A coarse test: edges that may leave samples open by the group's bound are handled again, precisely.
    M open = hn::Lt(hn::Abs(hn::Sub(near_y, hn::Round(near_y))), error);
    open = hn::Or(open, hn::Lt(hn::Abs(hn::Sub(far_y, hn::Round(far_y))), error));
    const V error_x = hn::MulAdd(hn::Mul(set(2.41F), error), hn::Add(set(1), steep),
                                 hn::Mul(set(8.1F * kRound), hn::Add(set(grid.half_cells.x), hn::Abs(near_x))));
    const auto holds_corner = [&](V low, V high) {
      return hn::And(hn::Le(hn::Sub(low, error), set(-0.5F)), hn::Ge(hn::Add(high, error), set(-0.5F)));
    };
    const V at_corner = hn::MulAdd(hn::Sub(set(-0.5F), near_y), slope, near_x);
    const M beside_corner =
        hn::AndNot(flat, hn::Ge(hn::Abs(hn::Sub(hn::Min(hn::Max(at_corner, low_x), high_x), set(-0.5F))), error_x));
    open = hn::Or(open, hn::AndNot(beside_corner, hn::And(holds_corner(low_x, high_x), holds_corner(low_y, high_y))));
    V row = hn::Min(hn::Max(hn::Ceil(low_y), set(0)), rows);
    const V end = hn::Min(hn::Max(hn::Ceil(high_y), set(0)), rows);
    const V stride = set(static_cast<float>(grid.padded_rows));
    const M left = hn::And(used, hn::Xor(hn::Lt(x0, set(-0.5F)), hn::Lt(x1, set(-0.5F))));
    const M upper_right = hn::Ge(hn::IfThenElse(hn::Lt(y0, y1), x1, x0), set(-0.5F));
    V from = end;  // the first row above the point where the edge crosses the light's left side
    for (;;) {
      const M crossed = hn::And(used, hn::Lt(row, end));
      if (hn::AllFalse(d, crossed)) break;
      const V x = hn::Min(hn::Max(hn::Add(near_x, hn::Mul(hn::Sub(row, near_y), slope)), low_x), high_x);
      const auto number = hn::ConvertTo(di, hn::IfThenElseZero(crossed, row));
      const V column = hn::Sub(x, hn::GatherIndex(d, grid.shift.data(), number));
      const V first = hn::Max(hn::Ceil(column), set(0));
      const M right = hn::Ge(x, set(-0.5F)), lands = hn::And(crossed, hn::And(right, hn::Lt(first, columns)));
      from = hn::Min(from, hn::IfThenElse(hn::AndNot(hn::Xor(right, upper_right), crossed), row, end));
      const auto place = hn::ConvertTo(di, hn::IfThenElseZero(lands, hn::Add(hn::Mul(first, stride), row)));
      pack(place, hn::RebindMask(di, lands), di, s_.landing.data() + landed);
      pack(hn::ConvertTo(di, jump), hn::RebindMask(di, lands), di, s_.jump.data() + landed);
      landed += hn::CountTrue(d, lands);
      const V on_light = hn::Min(hn::Max(hn::Round(column), set(0)), hn::Sub(columns, set(1)));
      const M near_column = hn::Lt(hn::Abs(hn::Sub(column, on_light)), error_x);
      open = hn::Or(open, hn::And(crossed, near_column));
      row = hn::Add(row, set(1));
      if (landed + hn::Lanes(d) > s_.landing.size()) grow_landing();
    }

    const bool any_left = !hn::AllFalse(d, left);
    if (any_left) {
      const V inverse = hn::Div(delta_y, delta_x);
      const V y = hn::Min(hn::Max(hn::Add(near_y, hn::Mul(hn::Sub(set(-0.5F), near_x), inverse)), low_y), high_y);
      const V error_y = hn::MulAdd(hn::Mul(set(2.41F), error), hn::Add(set(1), hn::Abs(inverse)),
                                   hn::Mul(set(8.1F * kRound), hn::Add(set(grid.half_cells.y), hn::Abs(near_y))));
      open = hn::Or(open, hn::And(left, hn::Lt(hn::Abs(hn::Add(y, set(0.5F))), error_y)));
      // Next to light rows, `from` is more precise than the division: y is used only below the first row.
      const M over_corner = hn::Or(hn::Gt(from, set(0)), hn::Gt(y, set(-0.5F)));
      const M above = hn::And(left, hn::And(over_corner, hn::Lt(from, rows)));
      const V up = hn::IfThenElse(hn::Lt(x0, x1), k, hn::Neg(k));
      change_left(from, up, above);
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
    const std::size_t count = pack(row, which, D(), rows);
    pack(up, which, D(), ups);
    for (std::size_t lane = 0; lane < count; ++lane) {
      Counter& cell = changes_.left[static_cast<std::size_t>(rows[lane])];
      cell = static_cast<Counter>(cell + static_cast<Counter>(ups[lane]));
    }
  }

  void look_again(std::size_t first, M which) {
    const CrossingTable& table = f_.crossing;
    for_each_lane(which, [&](std::size_t lane) {
      const std::size_t i = first + lane;
      const auto number = std::bit_cast<std::uint32_t>(table[kEdge][i]);
      const std::array projected{glm::vec2(table[kX0][i], table[kY0][i]), glm::vec2(table[kX1][i], table[kY1][i])};
      precisely(number & ~kUnsettled, table[kK][i], (number & kUnsettled) == 0, projected);
    });
    any_looked_at_ = true;
  }

  const ClusterInput& in_;
  EdgeScratch& f_;
  RowScratch& s_;
  const Changes<Counter>& changes_;
  const ClusterSample& at_;
  bool any_looked_at_ = false;
};

// ---- depths to bits ------------------------------------------------------------------------------------------------

/// Stores a bit for each lane, beginning at bit `place`: a multiple of eight, or of the number of lanes if smaller.
template <class Tag>
void store_bits(Tag d, hn::Mask<Tag> which, std::size_t place, std::uint8_t* bytes) {
  std::uint8_t found[8] = {};
  hn::StoreMaskBits(d, which, found);
  if (hn::Lanes(d) >= 8) {
    std::memcpy(bytes + place / 8, found, hn::Lanes(d) / 8);
  } else {
    const std::uint32_t before = place % 8 == 0 ? 0U : bytes[place / 8];
    bytes[place / 8] = static_cast<std::uint8_t>(before | std::uint32_t{found[0]} << place % 8);
  }
}

/// Sums as many rows as there are lanes, beginning at `row`, from the depths at their left ends.
template <class Tag, typename Counter>
void sum_rows(Tag d, const LightGrid& grid, const Changes<Counter>& changes, std::size_t row, SampleMask& mask) {
  auto* const bytes = reinterpret_cast<std::uint8_t*>(mask.bits);
  auto depths = hn::LoadU(d, changes.left + row);
  for (std::size_t column = 0; column < grid.columns; ++column) {
    const std::size_t at = column * grid.padded_rows + row;
    depths = hn::Add(depths, hn::LoadU(d, changes.cells + at));
    store_bits(d, hn::Eq(depths, hn::Zero(d)), at, bytes);
  }
}

/// Sums changes to depths; a light sample is visible where the depth is 0.
template <typename Counter>
void sum_up(const LightGrid& grid, const Changes<Counter>& changes, std::uint32_t depth_at_corner, SampleMask& mask) {
  std::int32_t depth = static_cast<std::int32_t>(depth_at_corner);
  for (std::uint32_t row = 0; row < grid.padded_rows; ++row) {  // left becomes the depth at the light's left side
    depth += changes.left[row];
    changes.left[row] = row < grid.rows ? static_cast<Counter>(depth) : Counter{1};
  }
  const hn::CappedTag<Counter, 64> many;
  const hn::CappedTag<Counter, 16> some;
  std::size_t row = 0;
  for (; row + hn::Lanes(many) <= grid.padded_rows; row += hn::Lanes(many)) sum_rows(many, grid, changes, row, mask);
  for (; row < grid.padded_rows; row += hn::Lanes(some)) sum_rows(some, grid, changes, row, mask);
  mask.count(mask_words(grid));
}

/// Returns D at the light's corner, from D at a light sample that is not open, counted by exact predicates.
template <typename Counter>
std::uint32_t depth_by_other_sample(const LightGrid& grid, const Changes<Counter>& changes, Open& open,
                                    const ClusterSample& at, OpenJudge& judge) {
  for (std::uint32_t row = 0, left = 0; row < grid.rows; ++row) {
    left += static_cast<std::uint32_t>(static_cast<std::int32_t>(changes.left[row]));
    if (std::find(open.rows.begin(), open.rows.end(), row) != open.rows.end()) continue;
    std::uint32_t depth = left;  // minus D(corner), modulo 2³²
    for (std::uint32_t column = 0; column < grid.columns; ++column) {
      depth += static_cast<std::uint32_t>(
          static_cast<std::int32_t>(changes.cells[std::size_t{column} * grid.padded_rows + row]));
      const std::uint32_t sample = row * grid.columns + column;
      if (std::find(open.samples.begin(), open.samples.end(), sample) != open.samples.end()) continue;
      return judge.depth(at, sample) - depth;
    }
  }
  open.pixel = true;
  return 0;
}

/// Returns D at the light's corner if no edge changes the depth: D at any light sample that is not open.
std::uint32_t depth_by_any_sample(const LightGrid& grid, Open& open, const ClusterSample& at, OpenJudge& judge) {
  for (std::uint32_t sample = 0; sample < grid.rows * grid.columns; ++sample) {
    if (std::find(open.samples.begin(), open.samples.end(), sample) != open.samples.end()) continue;
    return judge.depth(at, sample);
  }
  open.pixel = true;
  return 0;
}

/// Adds all changes, and the depth at the light's corner, for one view sample with projected edges. Returns false if
/// nothing changes on the light, so that its corner's depth is that of all of it.
template <typename Counter>
bool scatter_changes(const ClusterInput& in, EdgeScratch& found, RowScratch& scratch, std::vector<Counter>& counters,
                     const ClusterSample& at, OpenJudge& judge, std::uint32_t& depth, SampleMask& mask) {
  const LightGrid& grid = in.grid;
  const std::size_t cells = std::size_t{grid.columns} * grid.padded_rows;
  counters.resize(cells + grid.padded_rows);
  std::memset(counters.data(), 0, counters.size() * sizeof(Counter));
  const Changes<Counter> changes{counters.data(), counters.data() + cells};
  const bool any = SampleScatter<Counter>(in, found, scratch, changes, at)();
  if (found.open.corner) depth = depth_by_other_sample(grid, changes, found.open, at, judge);
  if (any) sum_up(grid, changes, depth, mask);
  return any;
}

/// Computes one view sample with its group's selected edges.
void scatter_sample(const ClusterInput& in, EdgeScratch& found, RowScratch& scratch, const ClusterSample& at,
                    OpenJudge& judge, SampleMask& mask) {
  const LightGrid& grid = in.grid;
  const bool edges = found.lists.settled.count + found.lists.unsettled.count > 0;
  const std::size_t triangles = found.lists.triangles.count;
  std::uint32_t depth =
      triangles == 0 ? 0
                     : count_to_corner({grid, in.tree, found.lists.triangles, at, !edges, in.light_plane}, found.open);
  bool changes_any = false;
  if (edges) {
    project(in, found, scratch, at, judge);
    // A path corner → left side → sample crosses each edge at most twice, and twice cancels, so |depth| ≤ `most`; a
    // counter type with more values than that cannot wrap to a false 0, whatever intermediate sums overflow.
    const std::size_t most =
        (found.open.corner ? triangles : depth) + 2 * (found.crossing.count + scratch.precise.size());
    if (most < 0x100)
      changes_any = scatter_changes(in, found, scratch, scratch.bytes, at, judge, depth, mask);
    else if (most < 0x10000)
      changes_any = scatter_changes(in, found, scratch, scratch.words, at, judge, depth, mask);
    else
      changes_any = scatter_changes(in, found, scratch, scratch.wide_words, at, judge, depth, mask);
  } else if (found.open.corner) {
    depth = depth_by_any_sample(grid, found.open, at, judge);
  }
  if (!changes_any) {
    mask.visible = depth == 0 ? grid.rows * grid.columns : 0;
    if (at.straddles || found.open.any()) fill(grid, depth == 0, mask);
  }
  if (at.straddles) cut_at_horizon(grid, at, found.open, mask);
}

void scatter_here(const ClusterInput& in, EdgeScratch& found, RowScratch& scratch, OpenJudge& judge,
                  std::span<SampleMask> masks) {
  if (scratch.landing.empty()) {
    scratch.landing.resize(4096);
    scratch.jump.resize(4096);
  }
  for_each_sample(in, found.lists, [&](std::size_t i) {
    const ClusterSample& at = in.samples[i];
    reset_open(in.grid, in.touch, at, found.open);
    scatter_sample(in, found, scratch, at, judge, masks[i]);
    if (found.open.any()) judge.decide(at, found.open, masks[i]);
  });
}

}  // namespace
}  // namespace penumbra::volumes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::volumes {

HWY_EXPORT(scatter_here);

void scatter(const ClusterInput& input, EdgeScratch& found, RowScratch& scratch, OpenJudge& judge,
             std::span<SampleMask> masks) {
  HWY_DYNAMIC_DISPATCH(scatter_here)(input, found, scratch, judge, masks);
}

}  // namespace penumbra::volumes
#endif
