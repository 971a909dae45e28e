// SPDX-License-Identifier: Apache-2.0
// View-sample mapping on a processor for light samples that are not in rows: each triangle is tested against the tiles
// that it may cover, a vector of light samples at a time. docs/view-sample.md, "Light samples anywhere".

#include "engines/vectors/horizon.hpp"
#include "vsm/vectors/pairs.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vsm/vectors/tiles.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "engines/vectors/vectors-inl.hpp"
#include "vsm/vectors/project-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace penumbra::vsm::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vectors::HWY_NAMESPACE;

using Tile = hn::CappedTag<float, LightTiles::kWide>;
using TileV = hn::Vec<Tile>;
using TileM = hn::Mask<Tile>;

std::uint32_t word_of(TileM which) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Tile(), which, bytes);
  return bytes[0] | std::uint32_t{bytes[1]} << 8U;
}

/// Bits of a tile, one for each slot.
struct TileBits {
  std::uint32_t hidden = 0, open = 0;
};

/// A triangle's place on the light, prepared for tests against tiles. (bound tile)
struct CellTriangle {
  std::array<float, 3> x, y;
  float low_x, high_x, low_y, high_y;
  float near;  // twice an area: light samples in the box with larger values are certainly on one side of an edge's line

  CellTriangle(const SurvivorTable& table, std::size_t i)
      : x{table[kX0][i], table[kX1][i], table[kX2][i]}, y{table[kY0][i], table[kY1][i], table[kY2][i]} {
    const float error = table[kError][i];
    low_x = std::min({x[0], x[1], x[2]}) - error;
    high_x = std::max({x[0], x[1], x[2]}) + error;
    low_y = std::min({y[0], y[1], y[2]}) - error;
    high_y = std::max({y[0], y[1], y[2]}) + error;
    const float width = high_x - low_x, height = high_y - low_y;
    near = 2.2F * error * (width + height) + 32 * kRound * width * height;
  }
};

class TileTest {
 public:
  TileTest(const PairInput& in, PairScratch& scratch, const ClusterSample& at, SampleMask& mask)
      : in_(in), tiles_(*in.grid.tiles), s_(scratch), at_(at), mask_(mask), project_(in, scratch, at) {}

  /// Clears the light samples that are certainly hidden; uncertain ones that are not hidden become open.
  void operator()() {
    fill(in_.grid, true, mask_);
    s_.survivors.reserve(kChunk + hn::Lanes(D()));
    for (std::size_t begin = 0; begin < s_.near.count && mask_.visible > 0; begin += kChunk) {
      const std::size_t end = std::min(begin + kChunk, s_.near.count);
      s_.again.clear();
      s_.asked_slots.clear();
      s_.survivors.count = 0;
      for (std::size_t i = begin; i < end; i += hn::Lanes(D())) project_(i, end);
      for (std::size_t i = 0; i < s_.survivors.count; ++i) cover(i);
      for (const std::uint32_t triangle : s_.again) cover_carefully(triangle);
      for (const auto& [triangle, slot] : s_.asked_slots) ask(triangle, slot);
      s_.pairs += end - begin;
      s_.careful += s_.again.size();
      mask_.visible = 0;
      for (std::size_t tile = 0; tile < tiles_.tile_count(); ++tile)
        mask_.visible += static_cast<std::uint32_t>(std::popcount(mask_.bits[tile]));
    }
    std::erase_if(s_.open.samples, [&](std::uint32_t sample) {
      const std::uint32_t slot = tiles_.slot_of[sample];
      return (mask_.bits[slot / LightTiles::kWide] >> slot % LightTiles::kWide & 1) == 0;
    });
  }

 private:
  void cover(std::size_t i) {
    const CellTriangle triangle(s_.survivors, i);
    const auto number = std::bit_cast<std::uint32_t>(s_.survivors[kTriangle][i]);
    if (!(triangle.near < 1e30F)) return s_.again.push_back(number);
    const float last = static_cast<float>(tiles_.row_from.size() - 1);
    const float step = std::clamp((triangle.low_y + 0.5F) * LightTiles::kStepsPerCell, 0.0F, last);
    const auto end = tiles_.rows.end();
    for (auto row = tiles_.rows.begin() + tiles_.row_from[static_cast<std::size_t>(step)];
         row != end && row->low <= triangle.high_y; ++row) {
      if (row->high < triangle.low_y) continue;
      for (std::uint32_t tile = row->first; tile < row->first + row->count; ++tile) {
        if (tiles_.tile_high[tile] < triangle.low_x) continue;
        if (tiles_.tile_low[tile] > triangle.high_x) break;
        if (mask_.bits[tile] != 0) take(tile, number, covered(tile, triangle));
      }
    }
  }

  TileBits covered(std::uint32_t tile, const CellTriangle& triangle) const {
    const Tile d;
    const TileV near = hn::Set(d, triangle.near), minus_near = hn::Neg(near);
    TileBits bits;
    for (std::size_t lane = 0; lane < LightTiles::kWide; lane += hn::Lanes(d)) {
      const std::size_t slot = std::size_t{tile} * LightTiles::kWide + lane;
      const TileV x = hn::LoadU(d, &tiles_.x[slot]), y = hn::LoadU(d, &tiles_.y[slot]);
      const TileM in_box =
          hn::And(hn::And(hn::Ge(x, hn::Set(d, triangle.low_x)), hn::Le(x, hn::Set(d, triangle.high_x))),
                  hn::And(hn::Ge(y, hn::Set(d, triangle.low_y)), hn::Le(y, hn::Set(d, triangle.high_y))));
      TileV least = hn::Set(d, 3e38F), most = hn::Set(d, -3e38F);
      for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t b = (a + 1) % 3;
        const TileV side =
            hn::MulSub(hn::Sub(x, hn::Set(d, triangle.x[a])), hn::Set(d, triangle.y[b] - triangle.y[a]),
                       hn::Mul(hn::Sub(y, hn::Set(d, triangle.y[a])), hn::Set(d, triangle.x[b] - triangle.x[a])));
        least = hn::Min(least, side);
        most = hn::Max(most, side);
      }
      const TileM hidden = hn::Or(hn::Gt(least, near), hn::Lt(most, minus_near));
      const TileM outside = hn::And(hn::Lt(least, minus_near), hn::Gt(most, near));
      bits.hidden |= word_of(hn::And(in_box, hidden)) << lane;
      bits.open |= word_of(hn::AndNot(hn::Or(hidden, outside), in_box)) << lane;
    }
    return bits;
  }

  /// Tests a triangle at any position, by four half-planes of the light.
  void cover_carefully(std::uint32_t triangle) {
    const CellPlanes planes = planes_in_cells(input_of(triangle));
    const Tile d;
    for (std::uint32_t tile = 0; tile < tiles_.tile_count(); ++tile) {
      if (mask_.bits[tile] == 0) continue;
      TileBits bits;
      for (std::size_t lane = 0; lane < LightTiles::kWide; lane += hn::Lanes(d)) {
        const std::size_t slot = std::size_t{tile} * LightTiles::kWide + lane;
        const TileV x = hn::LoadU(d, &tiles_.x[slot]), y = hn::LoadU(d, &tiles_.y[slot]);
        TileV least = hn::Set(d, 3e38F), most = hn::Set(d, -3e38F);  // extrema minus and plus their errors
        TileV may_be_least = most, may_be_most = least;
        for (const CellPlanes::Plane& plane : planes.planes) {
          const TileV f =
              hn::MulAdd(x, hn::Set(d, plane.per_x), hn::MulAdd(y, hn::Set(d, plane.per_y), hn::Set(d, plane.at)));
          const TileV low = hn::Sub(f, hn::Set(d, plane.near)), high = hn::Add(f, hn::Set(d, plane.near));
          least = hn::Min(least, low);
          most = hn::Max(most, high);
          may_be_least = hn::Max(may_be_least, low);
          may_be_most = hn::Min(may_be_most, high);
        }
        const TileV zero = hn::Zero(d);
        const TileM above = hn::Gt(least, zero), below = hn::Lt(most, zero);
        const TileM may_be_above = hn::Gt(may_be_most, zero), may_be_below = hn::Lt(may_be_least, zero);
        if (planes.side > 0) bits.hidden |= word_of(above) << lane;
        if (planes.side < 0) bits.hidden |= word_of(below) << lane;
        if (planes.side >= 0) bits.open |= word_of(may_be_above) << lane;
        if (planes.side <= 0) bits.open |= word_of(may_be_below) << lane;
      }
      take(tile, triangle, bits);
    }
  }

  void take(std::uint32_t tile, std::uint32_t triangle, const TileBits& bits) {
    std::uint16_t& word = mask_.bits[tile];
    word = static_cast<std::uint16_t>(word & ~bits.hidden);
    for (std::uint32_t left = bits.open & word; left != 0; left &= left - 1)
      s_.asked_slots.push_back(
          {triangle, tile * LightTiles::kWide + static_cast<std::uint32_t>(std::countr_zero(left))});
  }

  void ask(std::uint32_t triangle, std::uint32_t slot) {
    std::uint16_t& word = mask_.bits[slot / LightTiles::kWide];
    const std::uint32_t bit = 1U << slot % LightTiles::kWide, sample = tiles_.sample_of[slot];
    if ((word & bit) == 0) return;
    const std::optional<bool> hidden = hides(input_of(triangle), light_point(sample));
    if (!hidden) s_.open.samples.push_back(sample);
    if (hidden.value_or(false)) word = static_cast<std::uint16_t>(word & ~bit);
  }

  [[nodiscard]] CarefulInput input_of(std::uint32_t triangle) const {
    return {in_, at_, std::bit_cast<std::uint32_t>(s_.near[kTriangleSlot][triangle])};
  }
  [[nodiscard]] const glm::vec3& light_point(std::uint32_t sample) {
    if (!is_body(in_.light.kind)) return in_.light.points[sample];
    if (s_.light_points.empty()) {
      s_.light_points.resize(in_.light.sample_count());
      visibility::light_points_for(in_.light, in_.p[at_.pixel], s_.light_points.data());
    }
    return s_.light_points[sample];
  }

  const PairInput& in_;
  const LightTiles& tiles_;
  PairScratch& s_;
  const ClusterSample& at_;
  SampleMask& mask_;
  Projection project_;
};

void test_tiles_here(const PairInput& in, PairScratch& scratch, OpenJudge& judge, std::span<SampleMask> masks) {
  for_each_in_groups(in, scratch, [&](std::size_t i) {
    const ClusterSample& at = in.samples[i];
    SampleMask& mask = masks[i];
    scratch.open.clear();
    scratch.light_points.clear();
    TileTest(in, scratch, at, mask)();
    if (mask.visible == 0) return;
    if (at.straddles) cut_at_horizon(in.grid, at, scratch.open, mask);
    if (scratch.open.any()) judge.decide(at, scratch.open, mask);
  });
}

}  // namespace
}  // namespace penumbra::vsm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::vsm {

HWY_EXPORT(test_tiles_here);

void test_tiles(const PairInput& input, PairScratch& scratch, OpenJudge& judge, std::span<SampleMask> masks) {
  HWY_DYNAMIC_DISPATCH(test_tiles_here)(input, scratch, judge, masks);
}

}  // namespace penumbra::vsm
#endif
