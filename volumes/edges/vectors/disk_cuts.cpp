// SPDX-License-Identifier: Apache-2.0
// Edges that a sphere's disk cuts into casters that pass through it, on vector units with a scalar fallback.
// docs/edge-scatter.md, "Ends".

#include "volumes/edges/vectors/disk_cuts.hpp"

#include "engines/vectors/disk_plane.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volumes/edges/vectors/disk_cuts.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "engines/vectors/pack-inl.hpp"

#ifndef PENUMBRA_DISK_CUTS_ONCE
#define PENUMBRA_DISK_CUTS_ONCE
namespace penumbra::volumes {

/// Converts places in the plane to crossings.
struct DiskCells {
  glm::dvec2 middle, half;
  double cells, rounding, per_far, fixed;

  explicit DiskCells(const DiskCutInput& in)
      : middle(in.grid.first_cell),
        half(in.grid.half_cells),
        cells(std::max(half.x, half.y)),
        rounding(4.04 * static_cast<double>(kRound)),
        per_far(1.2 * static_cast<double>(in.at.on_light.per_foot) + rounding),
        fixed(1.2 * static_cast<double>(in.at.on_light.fixed) + rounding * glm::length(middle)) {}
};

/// Handles one caster in scalar code if it has a corner within rounding of the plane, or if its plane contains p.
class SlowDiskCut {
 public:
  SlowDiskCut(const DiskCutInput& in, const vectors::DiskPlane& plane, double slab, double most)
      : in_(in), plane_(plane), cells_(in), slab_(slab), most_(most) {}

  void add(std::size_t number, OpenJudge& judge, Open& open, CrossingTable& out) const {
    const vectors::NearCasters& near = *in_.grid.cones->casters;
    const double* row = &near.rows[number * vectors::NearCasters::kRow];
    if (row[vectors::NearCasters::kPlane] == static_cast<double>(in_.at.plane)) return;
    std::array<glm::dvec3, 3> corners;
    std::array<glm::dvec2, 3> place;
    std::array<double, 3> height{};
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = {row[3 * i], row[3 * i + 1], row[3 * i + 2]};
      place[i] = plane_.place(corners[i]);
      height[i] = plane_.height(corners[i]);
    }
    if (std::ranges::min(height) > slab_ || std::ranges::max(height) < -slab_) return;
    glm::dvec2 from = place[0], to = from;
    const bool passes = std::ranges::min(height) < 0 && std::ranges::max(height) >= 0;
    // Walks around the part of the caster in front of the plane, with the corners in order: the boundary leaves at
    // `from`, and returns at `to`.
    for (const auto& [i, next] : {std::pair{0U, 1U}, std::pair{1U, 2U}, std::pair{2U, 0U}}) {
      if (!passes || (height[i] < 0) == (height[next] < 0)) continue;
      (height[i] < 0 ? from : to) = plane_.pass(corners[std::min(i, next)], corners[std::max(i, next)]);
    }
    const double wide = around_cut(place, height, from, to);
    const glm::dvec2 low = glm::min(from, to) - wide, high = glm::max(from, to) + wide;
    if (low.x > most_ || low.y > most_ || high.x < -most_ || high.y < -most_) return;
    const int turn = passes ? turn_from(corners, near.triangle[number], judge) : 0;
    open.pixel = open.pixel || (passes && turn == 0);
    const double farthest = cells_.cells * std::max(glm::length(from), glm::length(to));
    const glm::vec2 a(cells_.middle + cells_.half * from), b(cells_.middle + cells_.half * to);
    out[kX0][out.count] = a.x;
    out[kY0][out.count] = a.y;
    out[kX1][out.count] = b.x;
    out[kY1][out.count] = b.y;
    out[kK][out.count] = static_cast<float>(turn);
    out[kError][out.count] =
        static_cast<float>(1.01 * (cells_.cells * wide + cells_.per_far * farthest + cells_.fixed));
    out[kEdge][out.count] = std::bit_cast<float>(kDiskCut);
    ++out.count;
  }

 private:
  static double distance(const glm::dvec2& x, const glm::dvec2& from, const glm::dvec2& to) {
    const glm::dvec2 direction = to - from;
    const double squared = glm::dot(direction, direction);
    const double share = squared > 0 ? std::clamp(glm::dot(x - from, direction) / squared, 0.0, 1.0) : 0.0;
    return glm::length(x - from - share * direction);
  }
  /// Returns how far the caster's part within the slab around the plane is, at most, from the segment where the caster
  /// passes through the plane.
  [[nodiscard]] double around_cut(const std::array<glm::dvec2, 3>& place, const std::array<double, 3>& height,
                                  const glm::dvec2& from, const glm::dvec2& to) const {
    double wide = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t next = (i + 1) % 3;
      if (std::abs(height[i]) <= slab_) wide = std::max(wide, distance(place[i], from, to));
      for (const double level : {-slab_, slab_}) {
        if ((height[i] < level) == (height[next] < level)) continue;
        const double share = (level - height[i]) / (height[next] - height[i]);
        wide = std::max(wide, distance(place[i] + share * (place[next] - place[i]), from, to));
      }
    }
    return wide;
  }
  /// Returns +1 if the corners run counter-clockwise as seen from p, −1 if clockwise; 0 if p is in their plane, or if
  /// they are so thin that the orientation is not certain.
  [[nodiscard]] int turn_from(const std::array<glm::dvec3, 3>& corners, std::uint32_t triangle,
                              OpenJudge& judge) const {
    const glm::dvec3 a = corners[0] - plane_.p, b = corners[1] - plane_.p, c = corners[2] - plane_.p;
    const double side = -glm::dot(a, glm::cross(b, c));
    // Error bound as in visibility::certainly_meets.
    if (std::abs(side) > 0x1p-46 * glm::length(a) * glm::length(b) * glm::length(c)) return side > 0 ? 1 : -1;
    const double along =
        glm::dot(judge.normal_towards(in_.at, triangle), glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    return along > 0 ? 1 : along < 0 ? -1 : 0;
  }

  const DiskCutInput& in_;
  const vectors::DiskPlane& plane_;
  DiskCells cells_;
  double slab_, most_;
};

}  // namespace penumbra::volumes
#endif

HWY_BEFORE_NAMESPACE();
namespace penumbra::volumes::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::ScalableTag<double>;
using Double = hn::Vec<Doubles>;
using Which = hn::Mask<Doubles>;
using vectors::HWY_NAMESPACE::pack;

struct Double3 {
  Double x, y, z;
};
Double number(double x) {
  return hn::Set(Doubles(), x);
}
Double product(const Double3& a, const Double3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
Double along(const glm::dvec3& n, const Double3& x) {
  return product({number(n.x), number(n.y), number(n.z)}, x);
}

/// Handles casters in vectors. Most casters that are near some neighbouring disk do not pass through this one: each
/// step discards some, and compacts the rest into full vectors.
class FastDiskCuts {
 public:
  FastDiskCuts(const DiskCutInput& in, OpenJudge& judge, Open& open, CrossingTable& out)
      : in_(in),
        near_(*in.grid.cones->near),
        rows_(in.grid.cones->casters->rows.data()),
        plane_(in.grid.cones->of[in.at.cone], glm::dvec3(in.at.p)),
        cells_(in),
        slab_(thin_slab(*in.grid.cones)),
        most_(vectors::around_disk(*in.grid.cones, in.grid.cones->of[in.at.cone])),
        slow_(in, plane_, slab_, most_),
        judge_(judge),
        open_(open),
        out_(out) {}

  void operator()() {
    const Doubles d;
    out_.reserve(out_.count + near_.count);
    const auto column = [&](std::size_t field, std::size_t i) { return hn::LoadU(d, &near_.columns[field][i]); };
    for (std::size_t i = 0; i < near_.count; i += hn::Lanes(d)) {
      const auto middle = [&](std::size_t axis, double of_p) {
        return hn::Sub(column(vectors::NearSpheres::kMiddle + axis, i), number(of_p));
      };
      const Double3 direction{middle(0, plane_.p.x), middle(1, plane_.p.y), middle(2, plane_.p.z)};
      // A radius includes a margin for rounding.
      const Double most_off = hn::Add(column(vectors::NearSpheres::kRadius, i), number(slab_));
      const Which near = hn::And(hn::FirstN(d, near_.count - i), hn::Le(hn::Abs(height(direction)), most_off));
      if (hn::AllFalse(d, near)) continue;
      spheres_.add(column(vectors::NearSpheres::kNumber, i), near);
      if (spheres_.full()) pick_meeting();
    }
    pick_meeting();
    cut();
  }

 private:
  static constexpr std::size_t kMost = 128;  // entries that wait for the next step
  /// Padded, since vectors may extend beyond the last entry.
  using Column = std::array<double, kMost + 2 * hn::MaxLanes(Doubles())>;
  /// Indices of casters.
  struct Waiting {
    void add(Double which, Which these) { count += pack(which, these, Doubles(), &numbers[count]); }
    [[nodiscard]] bool full() const { return count >= kMost; }

    HWY_ALIGN Column numbers;
    std::size_t count = 0;
  };
  /// x, y and z of three corners.
  struct Corners {
    HWY_ALIGN std::array<Column, 9> columns;

    [[nodiscard]] Double3 get(std::size_t corner, std::size_t first) const {
      const auto load = [&](std::size_t axis) { return hn::LoadU(Doubles(), &columns[3 * corner + axis][first]); };
      return {load(0), load(1), load(2)};
    }
  };
  /// Returns a vector of entries; lanes beyond the last entry get index 0, the first of all casters.
  static Double some(const Waiting& waiting, std::size_t first) {
    const Doubles d;
    return hn::IfThenElseZero(hn::FirstN(d, waiting.count - first), hn::LoadU(d, &waiting.numbers[first]));
  }

  /// Returns the largest distance of light samples from the plane: stored samples are rounded, and the plane is
  /// computed in double.
  static double thin_slab(const LightGrid::Cones& cones) {
    return 2 * static_cast<double>(cones.deviation) + 0x1p-40 * cones.reach;
  }
  [[nodiscard]] Double planes_of(Double numbers) const {
    const Double begins = hn::Mul(numbers, number(static_cast<double>(vectors::NearCasters::kRow)));
    return hn::GatherIndex(Doubles(), rows_ + vectors::NearCasters::kPlane,
                           hn::ConvertTo(hn::RebindToSigned<Doubles>(), begins));
  }
  /// Coordinates of a corner, computed as DiskPlane does.
  struct Corner {
    Double3 direction;
    Double height, s, t;
  };
  [[nodiscard]] Double height(const Double3& w) const { return hn::Sub(along(plane_.axis, w), number(plane_.end)); }
  [[nodiscard]] Corner corner(const Double3& direction) const {
    return {direction, height(direction), along(plane_.u, direction), along(plane_.v, direction)};
  }
  struct Passing {
    Double s, t;
    Double wide;  // largest distance of the caster's part within the slab
  };
  [[nodiscard]] Passing pass(const Corner& a, const Corner& b) const {
    const Double across = hn::Sub(a.height, b.height), share = hn::Div(a.height, across);
    const Double to_s = hn::Sub(b.s, a.s), to_t = hn::Sub(b.t, a.t);
    const Double size = hn::Add(hn::Abs(to_s), hn::Abs(to_t));
    return {hn::Add(a.s, hn::Mul(share, to_s)), hn::Add(a.t, hn::Mul(share, to_t)),
            hn::Div(hn::Mul(number(1.01 * slab_), size), hn::Abs(across))};
  }

  /// Selects, from casters whose spheres are near, those that meet the plane, or nearly do.
  void pick_meeting() {
    const Doubles d;
    // A scalar copy takes a fraction of the time of vector gathers.
    for (std::size_t i = 0; i < spheres_.count; ++i) {
      const double* row = rows_ + static_cast<std::size_t>(spheres_.numbers[i]) * vectors::NearCasters::kRow;
      for (std::size_t field = 0; field < corners_.columns.size(); ++field) corners_.columns[field][i] = row[field];
    }
    for (std::size_t i = 0; i < spheres_.count; i += hn::Lanes(d)) {
      const Double3 a = direction(corners_.get(0, i)), b = direction(corners_.get(1, i)),
                    c = direction(corners_.get(2, i));
      const Double high_a = height(a), high_b = height(b), high_c = height(c);
      const Which meets = hn::And(hn::Le(hn::Min(high_a, hn::Min(high_b, high_c)), number(slab_)),
                                  hn::Ge(hn::Max(high_a, hn::Max(high_b, high_c)), number(-slab_)));
      const Which these = hn::And(meets, hn::FirstN(d, spheres_.count - i));
      if (hn::AllFalse(d, these)) continue;
      std::size_t field = 0;
      for (const Double& x : {a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z})
        pack(x, these, d, &directions_.columns[field++][meeting_.count]);
      meeting_.add(hn::LoadU(d, &spheres_.numbers[i]), these);
      if (meeting_.full()) cut();
    }
    spheres_.count = 0;
  }
  [[nodiscard]] Double3 direction(const Double3& to) const {
    return {hn::Sub(to.x, number(plane_.p.x)), hn::Sub(to.y, number(plane_.p.y)), hn::Sub(to.z, number(plane_.p.z))};
  }

  void cut() {
    for (std::size_t i = 0; i < meeting_.count; i += hn::Lanes(Doubles()))
      cut(i, some(meeting_, i), hn::FirstN(Doubles(), meeting_.count - i));
    meeting_.count = 0;
  }

  void cut(std::size_t first, Double which, Which used) {
    const Doubles d;
    const Corner a = corner(directions_.get(0, first)), b = corner(directions_.get(1, first)),
                 c = corner(directions_.get(2, first));
    const Double zero = hn::Zero(d), slab = number(slab_);
    const Double nearest = hn::Min(hn::Abs(a.height), hn::Min(hn::Abs(b.height), hn::Abs(c.height)));
    const Double side = hn::Neg(
        product(a.direction, {hn::Sub(hn::Mul(b.direction.y, c.direction.z), hn::Mul(b.direction.z, c.direction.y)),
                              hn::Sub(hn::Mul(b.direction.z, c.direction.x), hn::Mul(b.direction.x, c.direction.z)),
                              hn::Sub(hn::Mul(b.direction.x, c.direction.y), hn::Mul(b.direction.y, c.direction.x))}));
    // Error bound as in visibility::certainly_meets.
    const Double unsure =
        hn::Mul(number(0x1p-46),
                hn::Sqrt(hn::Mul(product(a.direction, a.direction),
                                 hn::Mul(product(b.direction, b.direction), product(c.direction, c.direction)))));
    const Which sure = hn::And(hn::Gt(nearest, slab), hn::Gt(hn::Abs(side), unsure));
    add_slowly(which, hn::AndNot(sure, used));
    if (hn::AllFalse(d, hn::And(used, sure))) return;
    // Walks around the part of the caster in front of the plane, with the corners in order: the boundary leaves at
    // `from`, and returns at `to`.
    const Passing ab = pass(a, b), bc = pass(b, c), ac = pass(a, c);
    const Which a_before = hn::Lt(a.height, zero), b_before = hn::Lt(b.height, zero), c_before = hn::Lt(c.height, zero);
    const Which from_ab = hn::AndNot(b_before, a_before), from_bc = hn::AndNot(c_before, b_before),
                to_ab = hn::AndNot(a_before, b_before), to_bc = hn::AndNot(b_before, c_before);
    const auto choose = [&](Which is_ab, Which is_bc, Double of_ab, Double of_bc, Double of_ac) {
      return hn::IfThenElse(is_ab, of_ab, hn::IfThenElse(is_bc, of_bc, of_ac));
    };
    const Double from_s = choose(from_ab, from_bc, ab.s, bc.s, ac.s),
                 from_t = choose(from_ab, from_bc, ab.t, bc.t, ac.t);
    const Double to_s = choose(to_ab, to_bc, ab.s, bc.s, ac.s), to_t = choose(to_ab, to_bc, ab.t, bc.t, ac.t);
    const Double wide =
        hn::Max(choose(from_ab, from_bc, ab.wide, bc.wide, ac.wide), choose(to_ab, to_bc, ab.wide, bc.wide, ac.wide));
    const auto within = [&](Double x, Double y) {
      return hn::And(hn::Le(hn::Sub(hn::Min(x, y), wide), number(most_)),
                     hn::Ge(hn::Add(hn::Max(x, y), wide), number(-most_)));
    };
    const Which own = hn::Eq(planes_of(which), number(static_cast<double>(in_.at.plane)));
    const Which kept =
        hn::AndNot(own, hn::And(hn::And(used, sure), hn::And(within(from_s, to_s), within(from_t, to_t))));
    const std::size_t more = hn::CountTrue(d, kept);
    if (more == 0) return;
    const Double farthest = hn::Mul(number(cells_.cells), hn::Max(hn::Add(hn::Abs(from_s), hn::Abs(from_t)),
                                                                  hn::Add(hn::Abs(to_s), hn::Abs(to_t))));
    const Double error =
        hn::Mul(number(1.01), hn::Add(hn::Mul(number(cells_.cells), wide),
                                      hn::Add(hn::Mul(number(cells_.per_far), farthest), number(cells_.fixed))));
    const hn::Rebind<float, Doubles> floats;
    const auto store = [&](std::size_t field, Double x) {
      // Does not use Compress, for which Highway has a table in memory that g++ copies each time.
      HWY_ALIGN std::array<double, hn::MaxLanes(Doubles())> packed;
      pack(x, kept, d, packed.data());
      hn::StoreU(hn::DemoteTo(floats, hn::Load(d, packed.data())), floats, out_[field] + out_.count);
    };
    const auto cell = [&](Double x, double middle, double half) {
      return hn::Add(number(middle), hn::Mul(number(half), x));
    };
    store(kX0, cell(from_s, cells_.middle.x, cells_.half.x));
    store(kY0, cell(from_t, cells_.middle.y, cells_.half.y));
    store(kX1, cell(to_s, cells_.middle.x, cells_.half.x));
    store(kY1, cell(to_t, cells_.middle.y, cells_.half.y));
    store(kK, hn::CopySign(number(1), side));
    store(kError, error);
    hn::StoreU(hn::Set(floats, std::bit_cast<float>(kDiskCut)), floats, out_[kEdge] + out_.count);
    out_.count += more;
  }

  void add_slowly(Double which, Which these) {
    if (hn::AllFalse(Doubles(), these)) return;
    HWY_ALIGN std::array<double, hn::MaxLanes(Doubles())> numbers;
    const std::size_t count = pack(which, these, Doubles(), numbers.data());
    for (std::size_t i = 0; i < count; ++i) slow_.add(static_cast<std::size_t>(numbers[i]), judge_, open_, out_);
  }

  const DiskCutInput& in_;
  const vectors::NearSpheres& near_;
  const double* rows_;  // rows of all casters
  vectors::DiskPlane plane_;
  DiskCells cells_;
  double slab_, most_;
  SlowDiskCut slow_;
  OpenJudge& judge_;
  Open& open_;
  CrossingTable& out_;
  Waiting spheres_, meeting_;
  Corners corners_;     // corners of the casters that wait in spheres_
  Corners directions_;  // vectors from p to the corners of casters that meet the plane
};

void add_disk_cuts_here(const DiskCutInput& in, OpenJudge& judge, Open& open, CrossingTable& out) {
  FastDiskCuts(in, judge, open, out)();
}

}  // namespace
}  // namespace penumbra::volumes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::volumes {

HWY_EXPORT(add_disk_cuts_here);

void add_disk_cuts(const DiskCutInput& input, OpenJudge& judge, Open& open, CrossingTable& out) {
  HWY_DYNAMIC_DISPATCH(add_disk_cuts_here)(input, judge, open, out);
}

PassingEdge pass_disk(const DiskCutInput& in, const std::array<glm::dvec3, 2>& ends) {
  const vectors::DiskPlane plane(in.grid.cones->of[in.at.cone], glm::dvec3(in.at.p));
  const std::array heights{plane.height(ends[0]), plane.height(ends[1])};
  PassingEdge passing{{heights[0] >= 0, heights[1] >= 0}};
  if (passing.behind[0] == passing.behind[1]) return passing;
  const bool turn = vectors::comes_first(ends[1], ends[0]);
  const DiskCells cells(in);
  passing.place = glm::vec2(cells.middle + cells.half * plane.pass(ends[turn ? 1 : 0], ends[turn ? 0 : 1]));
  passing.share = static_cast<float>(heights[0] / (heights[0] - heights[1]));
  return passing;
}

}  // namespace penumbra::volumes
#endif
