// SPDX-License-Identifier: Apache-2.0
// depth-complexity on a processor: one counter for each light sample, in vectors of light samples. Each edge that the
// straight segment from the light's corner to a light sample crosses changes its counter by k.
// docs/depth-complexity.md, "On vector units".

#include "volumes/counters/vectors/count_samples.hpp"

#include "engines/vectors/horizon.hpp"
#include "volumes/edges/vectors/corner.hpp"
#include "volumes/edges/vectors/precise.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volumes/counters/vectors/count_samples.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "engines/vectors/vectors-inl.hpp"
#include "volumes/edges/vectors/projection-inl.hpp"
#include "volumes/edges/vectors/special-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace penumbra::volumes::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vectors::HWY_NAMESPACE;

using Tile = hn::CappedTag<float, LightTiles::kWide>;
using TileV = hn::Vec<Tile>;
using TileM = hn::Mask<Tile>;

constexpr float kCorner = -0.5F;  ///< both coordinates of the light's corner, where segments begin

/// A projected edge a→b, relative to the corner. Its line: side(x) = (x − a) × (b − a), > 0 to the right of it.
enum SeenField : std::size_t {
  kAX,
  kAY,
  kBX,
  kBY,
  kJumpLeft,    // change along a segment with a on its left and b on its right; the negative if a is on its right and b
                // on its left
  kCornerSide,  // side of the corner
  kOffA,        // error of the product of a segment with a, relative to the segment's |x| + |y|
  kOffB,
  kNearSide,  // a light sample with a larger |side| is certainly on one side of the edge
  kAround,    // a light sample farther than this from the edge's box is not near the edge
  kSeenFields
};
static_assert(kSeenFields == CountScratch::kFields);

class SampleCount {
 public:
  SampleCount(const ClusterInput& in, EdgeScratch& scratch, CountScratch& counting, const ClusterSample& at,
              OpenJudge& judge)
      : in_(in), tiles_(*in.grid.tiles), s_(scratch), c_(counting), at_(at), judge_(judge) {}

  /// Returns whether a counter may differ from the depth at the corner, or something is open.
  bool operator()() {
    const auto special = [&](const SpecialEdges& edges) { place_special(in_, s_, at_, edges, judge_); };
    Projection{in_, at_, s_.lists, s_.crossing}(special);
    c_.counted += s_.crossing.count;
    c_.edges.count = 0;
    c_.edges.reserve(s_.crossing.count);
    for (std::size_t i = 0; i < s_.crossing.count; ++i) see(i);
    c_.near.clear();
    for (std::uint32_t tile = 0; tile < tiles_.tile_count(); ++tile) count(tile);
    for (const CountScratch::Near& near : c_.near) look_again(near);
    return s_.crossing.count > 0 || s_.open.any();
  }

 private:
  [[nodiscard]] float& field(SeenField field, std::size_t i) { return c_.edges[field][i]; }

  void see(std::size_t i) {
    const CrossingTable& table = s_.crossing;
    const glm::vec2 a = glm::vec2(table[kX0][i], table[kY0][i]) - kCorner,
                    b = glm::vec2(table[kX1][i], table[kY1][i]) - kCorner, direction = b - a;
    const float size = std::abs(a.x) + std::abs(a.y) + std::abs(b.x) + std::abs(b.y), wide = std::abs(direction.x),
                high = std::abs(direction.y), around = 2.41F * (table[kError][i] + 4 * kRound * size);
    field(kAX, i) = a.x;
    field(kAY, i) = a.y;
    field(kBX, i) = b.x;
    field(kBY, i) = b.y;
    field(kJumpLeft, i) = in_.grid.side < 0 ? -table[kK][i] : table[kK][i];
    field(kCornerSide, i) = a.y * direction.x - a.x * direction.y;
    field(kOffA, i) = 16 * kRound * (std::abs(a.x) + std::abs(a.y));
    field(kOffB, i) = 16 * kRound * (std::abs(b.x) + std::abs(b.y));
    field(kNearSide, i) = around * (wide + high) + 16 * kRound * wide * high;
    field(kAround, i) = around;
    // The corner may be on either side of the edge, and not on the same side for all segments.
    if (is_near(i, glm::vec2(0))) s_.open.pixel = s_.open.pixel || is_near_itself(i, glm::vec2(0));
  }

  [[nodiscard]] bool is_near(std::size_t i, const glm::vec2& x) {
    const glm::vec2 a(field(kAX, i), field(kAY, i)), b(field(kBX, i), field(kBY, i)), direction = b - a, from_a = x - a;
    const float around = field(kAround, i);
    return std::min(a.x, b.x) - around <= x.x && x.x <= std::max(a.x, b.x) + around &&
           std::min(a.y, b.y) - around <= x.y && x.y <= std::max(a.y, b.y) + around &&
           std::abs(from_a.x * direction.y - from_a.y * direction.x) <= field(kNearSide, i);
  }
  /// Tests nearness with the errors of the edge's own ends.
  [[nodiscard]] bool is_near_itself(std::size_t i, const glm::vec2& x) {
    const CrossingTable& table = s_.crossing;
    const auto number = std::bit_cast<std::uint32_t>(table[kEdge][i]);
    const auto placed =
        place_edge({in_, at_, number & ~kUnsettled, table[kK][i], (number & kUnsettled) == 0,
                    std::array{glm::vec2(table[kX0][i], table[kY0][i]), glm::vec2(table[kX1][i], table[kY1][i])}},
                   s_.open);
    if (!placed) return true;
    const glm::vec2 a(field(kAX, i), field(kAY, i)), direction = glm::vec2(field(kBX, i), field(kBY, i)) - a,
                                                     from_a = x - a;
    const float size = std::abs(a.x) + std::abs(a.y) + std::abs(direction.x) + std::abs(direction.y);
    const float error = 1.2F * (placed->error_near + placed->error_far) + 16 * kRound * size;
    return std::abs(from_a.x * direction.y - from_a.y * direction.x) <=
           error * (std::abs(direction.x) + std::abs(direction.y)) + 16 * kRound * std::abs(direction.x * direction.y);
  }

  void look_again(const CountScratch::Near& near) {
    const glm::vec2 x = glm::vec2(tiles_.x[near.slot], tiles_.y[near.slot]) - kCorner;
    if (is_near_itself(near.edge, x)) s_.open.samples.push_back(tiles_.sample_of[near.slot]);
  }

  /// Adds all edges to a tile's counters.
  void count(std::uint32_t tile) {
    const Tile d;
    const std::size_t first = std::size_t{tile} * LightTiles::kWide;
    for (std::size_t lane = 0; lane < LightTiles::kWide; lane += hn::Lanes(d)) {
      const std::size_t slot = first + lane;
      const TileV corner = hn::Set(d, kCorner);
      const TileV x = hn::Sub(hn::LoadU(d, &tiles_.x[slot]), corner),
                  y = hn::Sub(hn::LoadU(d, &tiles_.y[slot]), corner);
      const TileV length = hn::Add(x, y), squared = hn::MulAdd(x, x, hn::Mul(y, y));
      TileV change = hn::Zero(d);
      for (std::size_t i = 0; i < s_.crossing.count; ++i) {
        const auto constant = [&](SeenField which) { return hn::Set(d, field(which, i)); };
        const TileV ax = constant(kAX), ay = constant(kAY), bx = constant(kBX), by = constant(kBY);
        // One decision for all edges that meet in an end.
        const TileM a_left = hn::Gt(hn::Mul(x, ay), hn::Mul(y, ax)), b_left = hn::Gt(hn::Mul(x, by), hn::Mul(y, bx));
        const TileM between = hn::Xor(a_left, b_left);
        const TileV delta_x = hn::Sub(bx, ax), delta_y = hn::Sub(by, ay);
        const TileV side = hn::MulSub(hn::Sub(x, ax), delta_y, hn::Mul(hn::Sub(y, ay), delta_x));
        if (!hn::AllFalse(d, between)) {
          const TileV along_a = hn::MulAdd(x, ax, hn::Mul(y, ay)), along_b = hn::MulAdd(x, bx, hn::Mul(y, by));
          const TileV round = hn::Mul(hn::Set(d, 16 * kRound), squared), off_a = hn::Mul(constant(kOffA), length),
                      off_b = hn::Mul(constant(kOffB), length), zero = hn::Zero(d);
          const TileM corner_right = hn::Gt(constant(kCornerSide), zero);
          const TileM in_front = decide(hn::And(hn::Gt(along_a, off_a), hn::Gt(along_b, off_b)),
                                        hn::And(hn::Lt(along_a, hn::Neg(off_a)), hn::Lt(along_b, hn::Neg(off_b))),
                                        same(a_left, corner_right));
          const TileV past_a = hn::Sub(along_a, squared), past_b = hn::Sub(along_b, squared),
                      off_past_a = hn::Add(off_a, round), off_past_b = hn::Add(off_b, round);
          const TileM beyond =
              decide(hn::And(hn::Lt(past_a, hn::Neg(off_past_a)), hn::Lt(past_b, hn::Neg(off_past_b))),
                     hn::And(hn::Gt(past_a, off_past_a), hn::Gt(past_b, off_past_b)), same(a_left, hn::Lt(side, zero)));
          const TileM crosses = hn::And(between, hn::And(in_front, beyond));
          const TileV jump = constant(kJumpLeft);
          change = hn::Add(change, hn::IfThenElseZero(crosses, hn::IfThenElse(a_left, jump, hn::Neg(jump))));
        }
        note_near(i, slot, x, y, side);
      }
      hn::StoreU(hn::Add(hn::LoadU(d, &c_.counters[slot]), change), d, &c_.counters[slot]);
    }
  }
  static TileM same(TileM a, TileM b) { return hn::Not(hn::Xor(a, b)); }
  static TileM decide(TileM yes, TileM no, TileM otherwise) { return hn::Or(yes, hn::AndNot(no, otherwise)); }

  void note_near(std::size_t i, std::size_t slot, TileV x, TileV y, TileV side) {
    const Tile d;
    const TileM near = hn::Le(hn::Abs(side), hn::Set(d, field(kNearSide, i)));
    if (hn::AllFalse(d, near)) return;
    const float around = field(kAround, i);
    const auto within = [&](TileV at, float a, float b) {
      return hn::And(hn::Ge(at, hn::Set(d, std::min(a, b) - around)), hn::Le(at, hn::Set(d, std::max(a, b) + around)));
    };
    const TileM in_box = hn::And(within(x, field(kAX, i), field(kBX, i)), within(y, field(kAY, i), field(kBY, i)));
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, hn::And(near, in_box), bytes);
    for (std::uint32_t left = bytes[0] | std::uint32_t{bytes[1]} << 8U; left != 0; left &= left - 1)
      c_.near.push_back({static_cast<std::uint32_t>(i),
                         static_cast<std::uint32_t>(slot) + static_cast<std::uint32_t>(std::countr_zero(left))});
  }

  const ClusterInput& in_;
  const LightTiles& tiles_;
  EdgeScratch& s_;
  CountScratch& c_;
  const ClusterSample& at_;
  OpenJudge& judge_;
};

/// Sets light samples visible whose counter and the depth at the corner add up to 0.
void see_counted(const LightTiles& tiles, const CountScratch& counting, float depth, SampleMask& mask) {
  const Tile d;
  mask.visible = 0;
  for (std::uint32_t tile = 0; tile < tiles.tile_count(); ++tile) {
    std::uint32_t bits = 0;
    for (std::size_t lane = 0; lane < LightTiles::kWide; lane += hn::Lanes(d)) {
      const TileV counter = hn::LoadU(d, &counting.counters[std::size_t{tile} * LightTiles::kWide + lane]);
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(d, hn::Eq(counter, hn::Set(d, -depth)), bytes);
      bits |= (bytes[0] | std::uint32_t{bytes[1]} << 8U) << lane;
    }
    mask.bits[tile] = static_cast<std::uint16_t>(bits & tiles.used[tile]);
    mask.visible += static_cast<std::uint32_t>(std::popcount(mask.bits[tile]));
  }
}

/// Returns the D at the corner that agrees with the edges, from D at a light sample that is not open, counted by exact
/// predicates.
std::optional<float> depth_by_one(const LightTiles& tiles, const CountScratch& counting, const Open& open,
                                  const ClusterSample& at, OpenJudge& judge) {
  for (std::size_t slot = 0; slot < counting.counters.size(); ++slot) {
    const std::uint32_t sample = tiles.sample_of[slot];
    if (sample == LightTiles::kNone) continue;
    if (std::find(open.samples.begin(), open.samples.end(), sample) != open.samples.end()) continue;
    return static_cast<float>(judge.depth(at, sample)) - counting.counters[slot];
  }
  return std::nullopt;
}

void count_one(const ClusterInput& in, EdgeScratch& scratch, CountScratch& counting, const ClusterSample& at,
               OpenJudge& judge, SampleMask& mask) {
  const LightTiles& tiles = *in.grid.tiles;
  const std::size_t some = scratch.lists.settled.count + scratch.lists.unsettled.count;
  float depth = 0;
  if (scratch.lists.triangles.count > 0) {
    depth = static_cast<float>(
        count_to_corner({in.grid, in.tree, scratch.lists.triangles, at, some == 0, in.light_plane}, scratch.open));
  }
  counting.counters.assign(tiles.tile_count() * LightTiles::kWide, 0);
  const bool changes = some > 0 && SampleCount(in, scratch, counting, at, judge)();
  if (scratch.open.corner && !scratch.open.pixel) {
    const std::optional<float> found = depth_by_one(tiles, counting, scratch.open, at, judge);
    if (!found) scratch.open.pixel = true;
    depth = found.value_or(0);
  }
  if (changes || scratch.open.corner) {
    see_counted(tiles, counting, depth, mask);
  } else {
    mask.visible = depth == 0 ? in.grid.sample_count : 0;
    if (at.straddles || scratch.open.any()) fill(in.grid, depth == 0, mask);
  }
  if (at.straddles) cut_at_horizon(in.grid, at, scratch.open, mask);
}

void count_samples_here(const ClusterInput& in, EdgeScratch& scratch, CountScratch& counting, OpenJudge& judge,
                        std::span<SampleMask> masks) {
  for_each_sample(in, scratch.lists, [&](std::size_t i) {
    const ClusterSample& at = in.samples[i];
    reset_open(in.grid, in.touch, at, scratch.open);
    count_one(in, scratch, counting, at, judge, masks[i]);
    if (scratch.open.any()) judge.decide(at, scratch.open, masks[i]);
  });
}

}  // namespace
}  // namespace penumbra::volumes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::volumes {

HWY_EXPORT(count_samples_here);

void count_samples(const ClusterInput& input, EdgeScratch& scratch, CountScratch& counting, OpenJudge& judge,
                   std::span<SampleMask> masks) {
  HWY_DYNAMIC_DISPATCH(count_samples_here)(input, scratch, counting, judge, masks);
}

}  // namespace penumbra::volumes
#endif
