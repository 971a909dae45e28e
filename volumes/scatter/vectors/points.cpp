// SPDX-License-Identifier: Apache-2.0
// Edge scatter on a processor for light samples that are not in rows: an edge is tested against the tiles that it
// passes, a vector of light samples at a time. All other light samples of a row that are right of the edge change by
// the same number. docs/edge-scatter.md, "Light samples anywhere".

#include "volumes/scatter/vectors/points.hpp"

#include "engines/vectors/horizon.hpp"
#include "volumes/edges/vectors/corner.hpp"
#include "volumes/edges/vectors/disk_cuts.hpp"
#include "volumes/edges/vectors/precise.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volumes/scatter/vectors/points.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "engines/vectors/vectors-inl.hpp"
#include "volumes/edges/vectors/projection-inl.hpp"
#include "volumes/scatter/vectors/tile_rows-inl.hpp"
#include "volumes/edges/vectors/special-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace penumbra::volumes::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vectors::HWY_NAMESPACE;

using Tile = hn::CappedTag<float, LightTiles::kWide>;
using TileM = hn::Mask<Tile>;

std::uint32_t bits_of(TileM which) {
  std::uint8_t bytes[8] = {};
  std::uint16_t word = 0;
  hn::StoreMaskBits(Tile(), which, bytes);
  std::memcpy(&word, bytes, sizeof word);
  return word;
}

/// Changes of the depth along the path from the light's corner to a light sample, without `corner`: up the light's left
/// side to a row's lowest light sample, from there to the right to a tile, and within the tile to each light sample.
struct PointChanges {
  std::int32_t* rows;   // for each row: change for it, and those above
  std::int32_t* tiles;  // for each tile: change for it, and those to the right; each row has one more place than tiles
  vectors::SlotFloats& slots;
  std::uint8_t* is_touched;  // for each tile: its slots may not be 0
  std::uint32_t* touched;    // indices of these tiles
  std::size_t touched_count = 0;
  std::int32_t corner = 0;
};

class PointScatter {
 public:
  PointScatter(const ClusterInput& in, EdgeScratch& found, PointChanges& changes, OpenJudge& judge)
      : in_(in), tiles_(*in.grid.tiles), s_(found), changes_(changes), judge_(judge), find_(tiles_) {}

  /// Returns whether the depth may change anywhere on the light, or something is open.
  bool operator()(const ClusterSample& at) {
    at_ = &at;
    own_.reset();
    const auto special = [&](const SpecialEdges& edges) { place_special(in_, s_, at, edges, judge_); };
    Projection{in_, at, s_.lists, s_.crossing}(special);
    if (at.meets_end) add_disk_cuts({in_.grid, at}, judge_, s_.open, s_.crossing);
    for (std::size_t i = 0; i < s_.crossing.count; i += hn::Lanes(D())) add(i);
    return s_.crossing.count > 0 || s_.open.any();
  }

 private:
  [[nodiscard]] bool is_disk_cut(const UpwardEdge& e) const {
    return std::bit_cast<std::uint32_t>(s_.crossing[kEdge][e.crossing()]) == kDiskCut;
  }

  void add(std::size_t first) {
    const UpwardVectors e = turn_upward(in_.grid, s_.crossing, first, edges_);
    if (!hn::AllFalse(D(), e.beside_left))
      for_each_lane(e.beside_left, [&](std::size_t i) { change_beside({edges_, i}); });
    find_(e, rows_);
    for (std::size_t i = 0; i < rows_.count; ++i) cross(rows_.where[i], rows_.steps[i]);
  }

  static std::int32_t jump_of(const UpwardEdge& e) { return static_cast<std::int32_t>(e[kJump]); }

  /// A path along a row crosses the edge if the edge passes the row's height left of the path's end. The left side
  /// itself crosses the edge once for each of its ends that is left of the light, as if the edge continued to the left
  /// from there.
  void change_beside(const UpwardEdge& e) {
    if (e[kBottom] <= -0.5F) change_corner(e);
    if (e[kHighX] < -0.5F) change_above(e[kHighY], jump_of(e));
    if (e[kLowX] < -0.5F) change_above(e[kLowY], -jump_of(e));
  }

  /// Handles the light's corner, where changes begin.
  void change_corner(const UpwardEdge& e) {
    constexpr float kCorner = -0.5F;
    const float side = e.side_of(kCorner, kCorner);
    const bool around = e[kLeftmost] <= kCorner && kCorner <= e[kRightmost] && kCorner <= e[kTop];
    if (around && !(std::abs(side) > e[kNear])) s_.open.corner = s_.open.corner || !(std::abs(side) > own(e).near);
    if (e[kLowY] <= kCorner && kCorner < e[kHighY] && side > 0) changes_.corner += jump_of(e);
    if (e[kHighY] <= kCorner && e[kHighX] < kCorner) changes_.corner += jump_of(e);
    if (e[kLowY] <= kCorner && e[kLowX] < kCorner) changes_.corner -= jump_of(e);
  }

  /// Adds a change to all rows whose paths are at y or higher.
  void change_above(float y, std::int32_t by) {
    const auto above = std::lower_bound(tiles_.rows.begin(), tiles_.rows.end(), y,
                                        [](const LightTiles::Row& row, float height) { return row.low < height; });
    changes_.rows[above - tiles_.rows.begin()] += by;
  }

  /// Adds an edge in a row of tiles. Tiles that it passes are tested; those to the right of them change as a whole if
  /// the edge crosses the row's path.
  HWY_INLINE void cross(std::int32_t where, std::int32_t steps) {
    const Tile d;
    const auto edge = static_cast<std::size_t>(where & EdgesInRows::kEdges);
    const std::int32_t row = where >> EdgesInRows::kRowShift;
    const std::int32_t* tiles_at = tiles_.tiles_at.data() + std::ptrdiff_t{row} * tiles_.steps;
    const auto from = static_cast<std::uint32_t>(tiles_at[steps & 0xffff] & 0xffff),
               end = static_cast<std::uint32_t>(tiles_at[steps >> 16] >> 16);
    const UpwardEdge e{edges_, edge};
    changes_.tiles[end + static_cast<std::uint32_t>(row)] += (where & EdgesInRows::kCrosses) != 0 ? jump_of(e) : 0;
    const auto direction = hn::Set(d, tiles_.row_low[static_cast<std::size_t>(row)]);
    const TileM low_above = hn::Gt(hn::Set(d, e[kLowY]), direction),
                high_above = hn::Gt(hn::Set(d, e[kHighY]), direction);
    for (std::uint32_t tile = from; tile < end; ++tile) {
      const auto begins = hn::Set(d, tiles_.tile_low[tile]);
      test({tile, hn::And(low_above, hn::Lt(hn::Set(d, e[kLowX]), begins)),
            hn::And(high_above, hn::Lt(hn::Set(d, e[kHighX]), begins))},
           edge);
    }
  }

  /// A tile that an edge passes. An end to the left of the tile (in all lanes, or in none) stands for the crossing of
  /// the edge with the path up the tile's left side, as if the edge continued to the left.
  struct Passed {
    std::uint32_t tile;
    TileM low_left, high_left;
  };
  /// Tests the path that begins where the row's path meets the tile, goes up to a light sample's height, and then
  /// right.
  HWY_INLINE void test(const Passed& passed, std::size_t edge) {
    const Tile d;
    const auto constant = [&](UpwardField field) { return hn::Set(d, edges_.fields[field][edge]); };
    const auto low_x = constant(kLowX), low_y = constant(kLowY), delta_x = constant(kDeltaX),
               delta_y = constant(kDeltaY);
    const auto jump = hn::IfThenElse(passed.low_left, hn::Neg(constant(kJump)), constant(kJump));
    const TileM one_left = hn::Xor(passed.low_left, passed.high_left);
    touch(passed.tile);
    for (std::size_t lane = 0; lane < LightTiles::kWide; lane += hn::Lanes(d)) {
      const std::size_t slot = std::size_t{passed.tile} * LightTiles::kWide + lane;
      const auto x = hn::Load(d, &tiles_.x[slot]), y = hn::Load(d, &tiles_.y[slot]);
      const auto side = hn::MulSub(hn::Sub(x, low_x), delta_y, hn::Mul(hn::Sub(y, low_y), delta_x));
      const TileM over_low = hn::Ge(y, low_y), over_high = hn::Ge(y, constant(kHighY)),
                  right = hn::Gt(side, hn::Zero(d)), between = hn::AndNot(over_high, over_low);
      const TileM changes = hn::Or(hn::And(between, hn::Xor(right, passed.low_left)), hn::And(over_high, one_left));
      float* slots = &changes_.slots[slot];
      hn::Store(hn::Add(hn::Load(d, slots), hn::IfThenElseZero(changes, jump)), d, slots);
      const TileM near = hn::Le(hn::Abs(side), constant(kNear));
      if (HWY_UNLIKELY(!hn::AllFalse(d, near))) look_again({edges_, edge}, slot, side, bits_of(near));
    }
  }
  void touch(std::uint32_t tile) {
    changes_.touched[changes_.touched_count] = tile;
    changes_.touched_count += changes_.is_touched[tile] ^ 1U;
    changes_.is_touched[tile] = 1;
  }

  /// An edge with the errors of its own ends.
  struct OwnEdge {
    std::size_t crossing;
    ProjectedEdge placed;
    float near;  // as kNear
  };
  const OwnEdge& own(const UpwardEdge& e) {
    if (own_ && own_->crossing == e.crossing()) return *own_;
    if (is_disk_cut(e)) return own_.emplace(OwnEdge{e.crossing(), {}, e[kNear]});
    const CrossingTable& table = s_.crossing;
    const std::size_t i = e.crossing();
    PreciseInput precise = precise_of(e);
    precise.projected = {glm::vec2(table[kX0][i], table[kY0][i]), glm::vec2(table[kX1][i], table[kY1][i])};
    const float error = table[kError][i], wide = std::abs(e[kDeltaX]);
    const ProjectedEdge placed =
        place_edge(precise, s_.open).value_or(ProjectedEdge{.error_near = error, .error_far = error});
    return own_.emplace(
        OwnEdge{e.crossing(), placed,
                1.2F * (placed.error_near + placed.error_far) * (wide + e[kDeltaY]) + 16 * kRound * wide * e[kDeltaY]});
  }
  [[nodiscard]] PreciseInput precise_of(const UpwardEdge& e) const {
    const auto number = std::bit_cast<std::uint32_t>(s_.crossing[kEdge][e.crossing()]);
    return {in_, *at_, number & ~kUnsettled, s_.crossing[kK][e.crossing()], (number & kUnsettled) == 0, std::nullopt};
  }

  /// Tests again the light samples that are within the group's error of the edge's line: `near`, one bit for each.
  HWY_NOINLINE void look_again(const UpwardEdge& e, std::size_t slot, hn::Vec<Tile> side, std::uint32_t near) {
    HWY_ALIGN float sides[LightTiles::kWide];
    hn::Store(side, Tile(), sides);
    for (; near != 0; near &= near - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(near));
      look_again(e, slot + i, sides[i]);
    }
  }
  void look_again(const UpwardEdge& e, std::size_t slot, float side) {
    const float x = tiles_.x[slot], y = tiles_.y[slot];
    if (y < e[kBottom] || y > e[kTop] || x < e[kLeftmost] || x > e[kRightmost]) return;
    const auto& [crossing, s, near] = own(e);
    if (std::abs(side) > near) return;
    const std::uint32_t sample = tiles_.sample_of[slot];
    if (is_disk_cut(e)) return s_.open.samples.push_back(sample);
    // An end that may be on either side of the sample's height makes the path's crossing uncertain.
    const bool at_end = std::abs(s.near.y - y) < 2 * s.error_near || std::abs(s.far.y - y) < 2 * s.error_far;
    const bool has_y = e[kLowY] <= y && y < e[kHighY];
    const int exact =
        at_end || s.may_be_cut || !has_y ? 0 : side_of_direction(precise_of(e), judge_.direction_to(*at_, sample));
    if (exact == 0 && (at_end || s.may_be_cut || has_y)) s_.open.samples.push_back(sample);
    const bool is_right = (exact < 0) == (s_.crossing[kY0][e.crossing()] < s_.crossing[kY1][e.crossing()]);
    if (exact != 0 && is_right != (side > 0)) changes_.slots[slot] += is_right ? e[kJump] : -e[kJump];
  }

  const ClusterInput& in_;
  const LightTiles& tiles_;
  EdgeScratch& s_;
  PointChanges& changes_;
  OpenJudge& judge_;
  RowsFinder find_;
  const ClusterSample* at_ = nullptr;
  UpwardEdges edges_;           // edges that are being added
  EdgesInRows rows_;            // the rows that they are in
  std::optional<OwnEdge> own_;  // the edge tested last
};

/// Calls `visit(tile, depth)` with the depth that the changes give a tile, without those of its slots.
template <typename Visit>
void for_each_tile(const LightTiles& tiles, const PointChanges& changes, std::int32_t depth_at_corner, Visit visit) {
  std::int32_t at_left = depth_at_corner - changes.corner;
  const std::int32_t* change = changes.tiles;
  for (std::size_t i = 0; i < tiles.rows.size(); ++i, ++change) {
    at_left += changes.rows[i];
    std::int32_t depth = at_left;
    const LightTiles::Row& row = tiles.rows[i];
    for (std::uint32_t tile = row.first; tile < row.first + row.count; ++tile) visit(tile, depth += *change++);
  }
}

/// Sums changes to depths; a light sample is visible where the depth is 0. Resets slots to 0, and tiles to untouched.
void sum_up(const LightTiles& tiles, PointChanges& changes, std::int32_t depth_at_corner, std::int32_t* depths,
            SampleMask& mask) {
  const Tile d;
  for_each_tile(tiles, changes, depth_at_corner, [&](std::uint32_t tile, std::int32_t depth) { depths[tile] = depth; });
  for (std::size_t tile = 0; tile < tiles.tile_count(); ++tile)  // without a branch, which would be mispredicted
    mask.bits[tile] = static_cast<std::uint16_t>(tiles.used[tile] & -static_cast<std::int32_t>(depths[tile] == 0));
  for (std::size_t i = 0; i < changes.touched_count; ++i) {
    const std::uint32_t tile = changes.touched[i];
    const auto zero = hn::Set(d, static_cast<float>(-depths[tile]));
    std::uint32_t bits = 0;
    for (std::size_t lane = 0; lane < LightTiles::kWide; lane += hn::Lanes(d)) {
      float* slots = &changes.slots[std::size_t{tile} * LightTiles::kWide + lane];
      bits |= bits_of(hn::Eq(hn::Load(d, slots), zero)) << lane;
      hn::Store(hn::Zero(d), d, slots);
    }
    mask.bits[tile] = static_cast<std::uint16_t>(bits & tiles.used[tile]);
    changes.is_touched[tile] = 0;
  }
  mask.count(tiles.tile_count());
}

/// Returns D at the light's corner as the edges require, from D at a light sample that is not open, counted by exact
/// predicates. May be negative, since an edge may pass the corner on the wrong side.
std::int32_t depth_by_a_sample(const LightTiles& tiles, const PointChanges& changes, Open& open,
                               const ClusterSample& at, OpenJudge& judge) {
  std::optional<std::int32_t> depth;
  for_each_tile(tiles, changes, 0, [&](std::uint32_t tile, std::int32_t change) {
    for (std::size_t slot = std::size_t{tile} * LightTiles::kWide; slot < (tile + std::size_t{1}) * LightTiles::kWide;
         ++slot) {
      const std::uint32_t sample = tiles.sample_of[slot];
      if (depth || sample == LightTiles::kNone) return;
      if (std::find(open.samples.begin(), open.samples.end(), sample) != open.samples.end()) continue;
      depth =
          static_cast<std::int32_t>(judge.depth(at, sample)) - change - static_cast<std::int32_t>(changes.slots[slot]);
    }
  });
  if (!depth) open.pixel = true;
  return depth.value_or(0);
}

/// Computes one view sample with its group's selected edges.
void scatter_sample(const ClusterInput& in, EdgeScratch& found, PointScratch& scratch, const ClusterSample& at,
                    OpenJudge& judge, SampleMask& mask) {
  const LightTiles& tiles = *in.grid.tiles;
  const std::size_t some =
      found.lists.settled.count + found.lists.unsettled.count + (at.meets_end ? std::size_t{1} : 0);
  std::int32_t depth = 0;
  if (found.lists.triangles.count > 0) {
    depth = static_cast<std::int32_t>(
        count_to_corner({in.grid, in.tree, found.lists.triangles, at, some == 0, in.light_plane}, found.open));
  }
  scratch.depths.resize(tiles.tile_count());
  scratch.tile_changes.assign(tiles.tile_count() + tiles.rows.size(), 0);
  scratch.tile_depths.resize(tiles.tile_count());
  scratch.row_changes.assign(tiles.rows.size() + 1, 0);
  scratch.is_touched.resize(tiles.tile_count());
  scratch.touched.resize(tiles.tile_count() + 1);
  PointChanges changes{scratch.row_changes.data(), scratch.tile_changes.data(), scratch.depths,
                       scratch.is_touched.data(), scratch.touched.data()};
  const bool changes_any = some > 0 && PointScatter(in, found, changes, judge)(at);
  if (found.open.corner) depth = depth_by_a_sample(tiles, changes, found.open, at, judge);
  if (changes_any) {
    sum_up(tiles, changes, depth, scratch.tile_depths.data(), mask);
  } else {
    mask.visible = depth == 0 ? in.grid.sample_count : 0;
    if (at.straddles || found.open.any()) fill(in.grid, depth == 0, mask);
  }
  if (at.straddles) cut_at_horizon(in.grid, at, found.open, mask);
}

void scatter_points_here(const ClusterInput& in, EdgeScratch& found, PointScratch& scratch, OpenJudge& judge,
                         std::span<SampleMask> masks) {
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

HWY_EXPORT(scatter_points_here);

void scatter_points(const ClusterInput& input, EdgeScratch& found, PointScratch& scratch, OpenJudge& judge,
                    std::span<SampleMask> masks) {
  HWY_DYNAMIC_DISPATCH(scatter_points_here)(input, found, scratch, judge, masks);
}

}  // namespace penumbra::volumes
#endif
