// Edge scatter on a processor for light samples that form no rows: an edge is tested against the tiles that it passes,
// light samples side by side; of all others of a row one number each says how they change. docs/edge-scatter.md, "Light
// samples anywhere".

#include "engines/vectors/horizon.hpp"
#include "volumes/scatter/vectors/disk_cuts.hpp"
#include "volumes/scatter/vectors/precise.hpp"
#include "volumes/scatter/vectors/scatter.hpp"

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
#include "volumes/scatter/vectors/projection-inl.hpp"
#include "volumes/scatter/vectors/special-inl.hpp"
#include "volumes/scatter/vectors/upward-inl.hpp"

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

/// By how much the depth changes from the light's corner, less `corner`: up the light's left side to a row's lowest
/// light sample, from there to the right to a tile, and within the tile to each light sample.
struct PointChanges {
  float* rows;   // this one, and those above
  float* tiles;  // each by itself
  vectors::SlotFloats& slots;
  std::uint16_t*
      touched;  // of as many tiles of a row as a vector has lanes, at the first: those where slots may not be 0
  float corner = 0;
};

class PointScatter {
 public:
  PointScatter(const ScatterInput& in, Scratch& scratch, PointChanges& changes, OpenJudge& judge)
      : in_(in),
        tiles_(*in.grid.tiles),
        x_(&tiles_.x[0]),
        y_(&tiles_.y[0]),
        slots_(&changes.slots[0]),
        s_(scratch),
        changes_(changes),
        judge_(judge) {}

  /// Whether the depth may change anywhere on the light, or something is open.
  bool operator()(const ClusterSample& at) {
    at_ = &at;
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
    UpwardEdges edges;
    const M beside = turn_upward(in_.grid, s_.crossing, first, edges);
    const bool some_left = !hn::AllFalse(D(), beside), one = tiles_.rows.size() == tiles_.tile_count();
    if (some_left) for_each_lane(beside, [&](std::size_t i) { change_beside({edges, i}); });
    const std::size_t count = std::min(hn::Lanes(D()), s_.crossing.count - first);
    for (std::size_t i = 0; i < count; ++i) {
      const UpwardEdge e{edges, i};
      !one ? cross<false, true>(e) : some_left ? cross<true, true>(e) : cross<true, false>(e);
    }
  }

  /// A way along a row has the edge between itself and the light's left side where the edge has its height and is left
  /// of its end. The left side itself crosses the edge once for each of its ends that is left of it, as if the edge
  /// went on from there to the left.
  void change_beside(const UpwardEdge& e) {
    own_.reset();
    if (e[kBottom] <= -0.5F) change_corner(e);
    if (e[kHighX] < -0.5F) change_above(e[kHighY], e[kJump]);
    if (e[kLowX] < -0.5F) change_above(e[kLowY], -e[kJump]);
  }

  /// The light's corner is where changes begin.
  void change_corner(const UpwardEdge& e) {
    constexpr float kCorner = -0.5F;
    const float side = e.side_of(kCorner, kCorner);
    const bool around = e[kLeftmost] <= kCorner && kCorner <= e[kRightmost] && kCorner <= e[kTop];
    if (around && !(std::abs(side) > e[kNear])) s_.open.corner = s_.open.corner || !(std::abs(side) > own(e).near);
    if (e[kLowY] <= kCorner && kCorner < e[kHighY] && side > 0) changes_.corner += e[kJump];
    if (e[kHighY] <= kCorner && e[kHighX] < kCorner) changes_.corner += e[kJump];
    if (e[kLowY] <= kCorner && e[kLowX] < kCorner) changes_.corner -= e[kJump];
  }

  /// All rows whose ways are at y and higher.
  void change_above(float y, float by) {
    const auto above = std::lower_bound(tiles_.rows.begin(), tiles_.rows.end(), y,
                                        [](const LightTiles::Row& row, float height) { return row.low < height; });
    changes_.rows[above - tiles_.rows.begin()] += by;
  }

  /// What tiles are tested against: in registers.
  struct TestedEdge {
    hn::Vec<Tile> low_x, low_y, high_x, high_y, way_x, way_y, jump, near;
  };

  /// Row by row. `kOne`: rows of one tile each, which is tested; `kLeft`: an end may be left of the light's left side.
  template <bool kOne, bool kLeft>
  void cross(const UpwardEdge& e) {
    own_.reset();
    const float low_x = e[kLowX], low_y = e[kLowY], high_x = e[kHighX], high_y = e[kHighY], bottom = e[kBottom],
                top = e[kTop], slope = e[kSlope], beside = e[kBeside], leftmost = e[kLeftmost],
                rightmost = e[kRightmost];
    const auto constant = [&](UpwardField field) { return hn::Set(Tile(), e[field]); };
    const TestedEdge tested{constant(kLowX), constant(kLowY), constant(kHighX), constant(kHighY),
                            constant(kWayX), constant(kWayY), constant(kJump),  constant(kNear)};
    const auto end = tiles_.rows.end();
    for (auto row = tiles_.rows.begin() + e.edges.tile_row[e.lane]; row != end && row->low <= top; ++row) {
      if (row->high < bottom) continue;
      const Ends ends{low_y > row->low, high_y > row->low};
      if constexpr (kOne) {  // its way ends where it begins: at the light's left side
        test(row->first, {kLeft && ends.low && low_x < -0.5F, kLeft && ends.high && high_x < -0.5F}, tested, e);
        continue;
      }
      const float from = low_x + (std::max(row->low, bottom) - low_y) * slope,
                  to = low_x + (std::min(row->high, top) - low_y) * slope;
      const float left = std::max(leftmost, std::min(from, to) - beside),
                  right = std::min(rightmost, std::max(from, to) + beside);
      for (std::uint32_t first = 0; first < row->count; first += static_cast<std::uint32_t>(hn::Lanes(Tile())))
        cross_tiles({row->first + first, row->count - first, row->low, left, right, ends}, tested, e);
    }
  }

  /// Whether the edge's ends are above a row's way.
  struct Ends {
    bool low, high;
  };
  /// As many tiles of a row as a vector has lanes, or the rest of it; the edge is between `left` and `right`.
  struct TilesOfRow {
    std::uint32_t first, count;
    float way, left, right;
    Ends above;
  };
  /// Tiles that it does not pass change as a whole if it crosses the row's way to the left of them.
  HWY_INLINE void cross_tiles(const TilesOfRow& its, const TestedEdge& t, const UpwardEdge& e) {
    const Tile d;
    const auto low = hn::LoadU(d, &tiles_.tile_low[its.first]), high = hn::LoadU(d, &tiles_.tile_high[its.first]);
    const TileM used = hn::FirstN(d, its.count);
    const TileM beside = hn::Or(hn::Gt(low, hn::Set(d, its.right)), hn::Lt(high, hn::Set(d, its.left)));
    const TileM passed = hn::AndNot(beside, used);
    if (its.above.high && !its.above.low) {
      const TileM right = hn::And(used, hn::Gt(side_of(low, hn::Set(d, its.way), t), hn::Zero(d)));
      float* tiles = changes_.tiles + its.first;
      hn::StoreU(hn::Add(hn::LoadU(d, tiles), hn::IfThenElseZero(hn::AndNot(passed, right), t.jump)), d, tiles);
    }
    std::uint32_t left = bits_of(passed);
    if (left == 0) return;
    changes_.touched[its.first] = static_cast<std::uint16_t>(changes_.touched[its.first] | left);
    const std::uint32_t after_low = its.above.low ? bits_of(hn::Lt(t.low_x, low)) : 0,
                        after_high = its.above.high ? bits_of(hn::Lt(t.high_x, low)) : 0;
    for (; left != 0; left &= left - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
      test(its.first + i, {(after_low >> i & 1) != 0, (after_high >> i & 1) != 0}, t, e);
    }
  }

  static hn::Vec<Tile> side_of(hn::Vec<Tile> x, hn::Vec<Tile> y, const TestedEdge& t) {
    return hn::MulSub(hn::Sub(x, t.low_x), t.way_y, hn::Mul(hn::Sub(y, t.low_y), t.way_x));
  }

  /// From where the row's way meets the tile up to a light sample's height, and then to the right. `crossed`: the way
  /// up crosses the edge at an end that is left of it, as if the edge went on from there to the left.
  HWY_INLINE void test(std::uint32_t tile, Ends crossed, const TestedEdge& t, const UpwardEdge& e) {
    const Tile d;
    const bool some_crossed = crossed.low || crossed.high;
    for (std::size_t lane = 0; lane < LightTiles::kWide; lane += hn::Lanes(d)) {
      const std::size_t slot = std::size_t{tile} * LightTiles::kWide + lane;
      const auto x = hn::Load(d, x_ + slot), y = hn::Load(d, y_ + slot);
      const auto side = side_of(x, y, t);
      const TileM over_low = hn::Ge(y, t.low_y), over_high = hn::Ge(y, t.high_y), right = hn::Gt(side, hn::Zero(d));
      const TileM between = hn::AndNot(over_high, over_low);
      TileM changes = hn::And(between, right);
      auto jump = t.jump;
      if (some_crossed) {
        if (crossed.low) changes = hn::AndNot(right, between);
        if (crossed.low != crossed.high) changes = hn::Or(changes, over_high);
        if (crossed.low) jump = hn::Neg(jump);
      }
      float* slots = slots_ + slot;
      hn::Store(hn::Add(hn::Load(d, slots), hn::IfThenElseZero(changes, jump)), d, slots);
      const TileM near = hn::Le(hn::Abs(side), t.near);
      if (hn::AllFalse(d, near)) continue;
      HWY_ALIGN float sides[LightTiles::kWide];
      hn::Store(side, d, sides);
      for (std::uint32_t left = bits_of(near); left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        look_again(e, slot + i, sides[i]);
      }
    }
  }

  /// An edge with the errors of its own ends.
  struct OwnEdge {
    ProjectedEdge placed;
    float near;  // as kNear
  };
  const OwnEdge& own(const UpwardEdge& e) {
    if (own_) return *own_;
    if (is_disk_cut(e)) return own_.emplace(OwnEdge{{}, e[kNear]});
    const CrossingTable& table = s_.crossing;
    const std::size_t i = e.crossing();
    PreciseInput precise = precise_of(e);
    precise.projected = {glm::vec2(table[kX0][i], table[kY0][i]), glm::vec2(table[kX1][i], table[kY1][i])};
    const float error = table[kError][i], wide = std::abs(e[kWayX]);
    const ProjectedEdge placed =
        place_edge(precise, s_.open).value_or(ProjectedEdge{.error_near = error, .error_far = error});
    return own_.emplace(OwnEdge{
        placed, 1.2F * (placed.error_near + placed.error_far) * (wide + e[kWayY]) + 16 * kRound * wide * e[kWayY]});
  }
  [[nodiscard]] PreciseInput precise_of(const UpwardEdge& e) const {
    const auto number = std::bit_cast<std::uint32_t>(s_.crossing[kEdge][e.crossing()]);
    return {in_, *at_, number & ~kUnsettled, s_.crossing[kK][e.crossing()], (number & kUnsettled) == 0, std::nullopt};
  }

  /// A light sample that the edge's line passes within the group's error.
  void look_again(const UpwardEdge& e, std::size_t slot, float side) {
    const float x = tiles_.x[slot], y = tiles_.y[slot];
    if (y < e[kBottom] || y > e[kTop] || x < e[kLeftmost] || x > e[kRightmost]) return;
    const auto& [s, near] = own(e);
    if (std::abs(side) > near) return;
    const std::uint32_t sample = tiles_.sample_of[slot];
    if (is_disk_cut(e)) return s_.open.samples.push_back(sample);
    // Where an end may be on either side of it, so may be what goes on from there.
    const bool at_end = std::abs(s.near.y - y) < 2 * s.error_near || std::abs(s.far.y - y) < 2 * s.error_far;
    const bool has_y = e[kLowY] <= y && y < e[kHighY];
    const int exact = at_end || s.may_be_cut || !has_y ? 0 : side_of_way(precise_of(e), judge_.way_to(*at_, sample));
    if (exact == 0 && (at_end || s.may_be_cut || has_y)) s_.open.samples.push_back(sample);
    const bool is_right = (exact < 0) == (s_.crossing[kY0][e.crossing()] < s_.crossing[kY1][e.crossing()]);
    if (exact != 0 && is_right != (side > 0)) changes_.slots[slot] += is_right ? e[kJump] : -e[kJump];
  }

  const ScatterInput& in_;
  const LightTiles& tiles_;
  const float *x_, *y_;  // of tiles_
  float* slots_;         // of changes_
  Scratch& s_;
  PointChanges& changes_;
  OpenJudge& judge_;
  const ClusterSample* at_ = nullptr;
  std::optional<OwnEdge> own_;  // of the edge that is being added
};

/// Calls `visit(tile, depth)` with the depth that changes give a tile, less what they say of its slots.
template <typename Visit>
void for_each_tile(const LightTiles& tiles, const PointChanges& changes, float depth_at_corner, Visit visit) {
  float depth = depth_at_corner - changes.corner;
  for (std::size_t i = 0; i < tiles.rows.size(); ++i) {
    depth += changes.rows[i];
    const LightTiles::Row& row = tiles.rows[i];
    for (std::uint32_t tile = row.first; tile < row.first + row.count; ++tile) visit(tile, depth + changes.tiles[tile]);
  }
}

/// How many bits are set of so many words.
std::uint32_t count_bits(const std::uint16_t* words, std::size_t count) {
  std::uint32_t bits = 0;
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4) {
    std::uint64_t four = 0;
    std::memcpy(&four, words + i, sizeof four);
    bits += static_cast<std::uint32_t>(std::popcount(four));
  }
  for (; i < count; ++i) bits += static_cast<std::uint32_t>(std::popcount(words[i]));
  return bits;
}

/// A light sample is visible where the depth is 0. Slots are 0 afterwards.
void sum_up(const LightTiles& tiles, const PointChanges& changes, std::int32_t depth_at_corner, SampleMask& mask) {
  const Tile d;
  for_each_tile(tiles, changes, static_cast<float>(depth_at_corner), [&](std::uint32_t tile, float depth) {
    changes.tiles[tile] = depth;
    mask.bits[tile] = depth == 0 ? tiles.used[tile] : std::uint16_t{0};
  });
  for (std::uint32_t first = 0; first < tiles.tile_count(); ++first) {
    for (std::uint32_t left = changes.touched[first]; left != 0; left &= left - 1) {
      const std::uint32_t tile = first + static_cast<std::uint32_t>(std::countr_zero(left));
      const auto zero = hn::Set(d, -changes.tiles[tile]);
      std::uint32_t bits = 0;
      for (std::size_t lane = 0; lane < LightTiles::kWide; lane += hn::Lanes(d)) {
        float* slots = &changes.slots[std::size_t{tile} * LightTiles::kWide + lane];
        bits |= bits_of(hn::Eq(hn::Load(d, slots), zero)) << lane;
        hn::Store(hn::Zero(d), d, slots);
      }
      mask.bits[tile] = static_cast<std::uint16_t>(bits & tiles.used[tile]);
    }
  }
  mask.visible = count_bits(mask.bits, tiles.tile_count());
}

/// D at the light's corner as the edges have it, from D at a light sample that is not open: exact predicates count
/// there. It may be less than 0, since an edge may pass the corner on the wrong side.
std::int32_t depth_by_a_sample(const LightTiles& tiles, const PointChanges& changes, Open& open,
                               const ClusterSample& at, OpenJudge& judge) {
  std::optional<std::int32_t> depth;
  for_each_tile(tiles, changes, 0, [&](std::uint32_t tile, float change) {
    for (std::size_t slot = std::size_t{tile} * LightTiles::kWide; slot < (tile + std::size_t{1}) * LightTiles::kWide;
         ++slot) {
      const std::uint32_t sample = tiles.sample_of[slot];
      if (depth || sample == LightTiles::kNone) return;
      if (std::find(open.samples.begin(), open.samples.end(), sample) != open.samples.end()) continue;
      depth =
          static_cast<std::int32_t>(judge.depth(at, sample)) - static_cast<std::int32_t>(change + changes.slots[slot]);
    }
  });
  if (!depth) open.pixel = true;
  return depth.value_or(0);
}

/// One view sample, its group's edges sorted out.
void scatter_sample(const ScatterInput& in, Scratch& scratch, const ClusterSample& at, OpenJudge& judge,
                    SampleMask& mask) {
  const LightTiles& tiles = *in.grid.tiles;
  const std::size_t some =
      scratch.lists.settled.count + scratch.lists.unsettled.count + (at.meets_end ? std::size_t{1} : 0);
  std::int32_t depth = 0;
  if (scratch.lists.triangles.count > 0) {
    depth = static_cast<std::int32_t>(
        count_to_corner({in.grid, in.tree, scratch.lists.triangles, at, some == 0, in.light_plane}, scratch.open));
  }
  scratch.depths.resize(tiles.tile_count());
  scratch.tile_changes.assign(tiles.tile_count() + LightTiles::kWide, 0);
  scratch.row_changes.assign(tiles.rows.size() + 1, 0);
  scratch.touched.assign(tiles.tile_count(), tiles.rows.size() == tiles.tile_count() ? 1 : 0);
  PointChanges changes{scratch.row_changes.data(), scratch.tile_changes.data(), scratch.depths, scratch.touched.data()};
  const bool changes_any = some > 0 && PointScatter(in, scratch, changes, judge)(at);
  if (scratch.open.corner) depth = depth_by_a_sample(tiles, changes, scratch.open, at, judge);
  if (changes_any) {
    sum_up(tiles, changes, depth, mask);
  } else {
    mask.visible = depth == 0 ? in.grid.sample_count : 0;
    if (at.straddles || scratch.open.any()) fill(in.grid, depth == 0, mask);
  }
  if (at.straddles) cut_at_horizon(in.grid, at, scratch.open, mask);
}

void scatter_points_here(const ScatterInput& in, Scratch& scratch, OpenJudge& judge, std::span<SampleMask> masks) {
  for_each_sample(in, scratch.lists, [&](std::size_t i) {
    const ClusterSample& at = in.samples[i];
    reset_open(in.grid, in.touch, at, scratch.open);
    scatter_sample(in, scratch, at, judge, masks[i]);
    if (scratch.open.any()) judge.decide(at, scratch.open, masks[i]);
  });
}

}  // namespace
}  // namespace penumbra::volumes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::volumes {

HWY_EXPORT(scatter_points_here);

void scatter_points(const ScatterInput& input, Scratch& scratch, OpenJudge& judge, std::span<SampleMask> masks) {
  HWY_DYNAMIC_DISPATCH(scatter_points_here)(input, scratch, judge, masks);
}

}  // namespace penumbra::volumes
#endif
