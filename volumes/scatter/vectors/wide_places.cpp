// SPDX-License-Identifier: Apache-2.0
// Places of edges for one view sample in vectors of doubles, with the operations of RowSum in the same order.

#include "volumes/scatter/vectors/wide_places.hpp"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volumes/scatter/vectors/wide_places.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace penumbra::volumes::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::ScalableTag<double>;
using Double = hn::Vec<Doubles>;
using Which = hn::Mask<Doubles>;

Double number(double x) {
  return hn::Set(Doubles(), x);
}

/// The operations are those of RowSum::direction_to, cut_to_window, place and placing_error, in the same order: an edge
/// may be placed by either code, and its ends may be those of edges that the other code places.
class SideBySide {
 public:
  explicit SideBySide(const PlacesFrame& frame) : f_(frame) {}

  void operator()(WidePlaces& places, std::size_t first) const {
    const Doubles d;
    const Direction a = direction_to(places.a, first), b = direction_to(places.b, first);
    const Double height = number(f_.height), error = hn::Max(a.error, b.error),
                 error_up = hn::Max(a.error_up, b.error_up);
    Which placed = hn::Gt(hn::Min(a.z, b.z), hn::Mul(number(8), error_up));
    for (int axis = 0; axis < 2; ++axis) {
      const Double window = number(2 * f_.middle[axis] + 2), off = number(f_.foot[axis] - f_.middle[axis]);
      placed = hn::And(placed, hn::And(holds(axis == 0 ? a.x : a.y, a.z, window, off),
                                       holds(axis == 0 ? b.x : b.y, b.z, window, off)));
    }
    if (f_.ends) {
      const Double room = hn::Mul(number(4), hn::Add(error_up, number(f_.error_height)));
      placed = hn::And(placed, hn::Lt(hn::Add(hn::Max(a.z, b.z), room), height));
    }
    const Double stretch_a = hn::Div(height, a.z), stretch_b = hn::Div(height, b.z);
    const Double ax = hn::Mul(stretch_a, a.x), ay = hn::Mul(stretch_a, a.y), bx = hn::Mul(stretch_b, b.x),
                 by = hn::Mul(stretch_b, b.y);
    const Double far = hn::Max(hn::Add(hn::Abs(ax), hn::Abs(ay)), hn::Add(hn::Abs(bx), hn::Abs(by)));
    const Double off = placing_error(hn::Max(stretch_a, stretch_b), error, error_up, far);
    const Double foot_x = number(f_.foot.x), foot_y = number(f_.foot.y);
    const Double x0 = hn::Add(foot_x, ax), y0 = hn::Add(foot_y, ay), x1 = hn::Add(foot_x, bx), y1 = hn::Add(foot_y, by);
    hn::Store(x0, d, &places.x0[first]);
    hn::Store(y0, d, &places.y0[first]);
    hn::Store(x1, d, &places.x1[first]);
    hn::Store(y1, d, &places.y1[first]);
    hn::Store(off, d, &places.error[first]);

    const Double width = number(f_.size.x), top = number(f_.size.y), around = hn::Mul(number(2), off);
    const Double low_x = hn::Min(x0, x1), high_x = hn::Max(x0, x1), low_y = hn::Min(y0, y1), high_y = hn::Max(y0, y1);
    const Which beside = hn::Or(hn::Or(hn::Lt(high_x, hn::Neg(around)), hn::Gt(low_x, hn::Add(width, around))),
                                hn::Or(hn::Lt(high_y, hn::Neg(around)), hn::Gt(low_y, hn::Add(top, around))));
    const Double zero = hn::Zero(d);
    const Which within =
        hn::And(hn::And(hn::Ge(low_x, zero), hn::Ge(low_y, zero)), hn::And(hn::Le(high_x, width), hn::Le(high_y, top)));
    const Which apart = hn::Or(hn::Gt(low_x, around), hn::Gt(low_y, around));
    const Which inside = hn::And(hn::And(within, apart), hn::Lt(off, number(0.5)));
    const auto bits_of = [&](Which which) {
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(d, which, bytes);
      return bytes[0];
    };
    const unsigned is_placed = bits_of(placed), is_beside = bits_of(beside), is_inside = bits_of(inside);
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
      const auto bit = [&](unsigned bits) { return (bits >> lane & 1U) != 0; };
      places.how[first + lane] = !bit(is_placed)  ? WidePlaces::kUnplaced
                                 : bit(is_beside) ? WidePlaces::kBeside
                                 : bit(is_inside) ? WidePlaces::kInside
                                                  : WidePlaces::kCrossing;
    }
  }

 private:
  struct Direction {
    Double x, y, z, error, error_up;
  };
  [[nodiscard]] Direction direction_to(const std::array<WidePlaces::Column, 3>& points, std::size_t first) const {
    const Doubles d;
    const auto from_p = [&](std::size_t axis) {
      return hn::Sub(hn::Load(d, &points[axis][first]), number(f_.p[static_cast<glm::length_t>(axis)]));
    };
    const Double x = from_p(0), y = from_p(1), z = from_p(2);
    const auto along = [&](const glm::dvec3& n) {
      return hn::Add(hn::Add(hn::Mul(number(n.x), x), hn::Mul(number(n.y), y)), hn::Mul(number(n.z), z));
    };
    const Double length = hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
    const Double error = hn::Mul(number(0x1p-53 * f_.skew), length);
    return {along(f_.axes[0]), along(f_.axes[1]), hn::Neg(along(f_.axes[2])),
            hn::Mul(hn::Mul(number(64), error), number(f_.per_length)), hn::Mul(number(32), error)};
  }
  /// Returns whether the end is inside both sides of the window.
  [[nodiscard]] Which holds(Double x, Double z, Double window, Double off) const {
    const Double at = hn::Add(hn::Mul(x, number(f_.height)), hn::Mul(off, z)), wide = hn::Mul(window, z);
    return hn::And(hn::Ge(hn::Sub(wide, at), hn::Zero(Doubles())), hn::Ge(hn::Add(wide, at), hn::Zero(Doubles())));
  }
  [[nodiscard]] Double placing_error(Double stretch, Double error, Double error_up, Double far) const {
    const Double up = hn::Div(hn::Add(number(f_.error_height), hn::Mul(stretch, error_up)), number(f_.height));
    const Double sum = hn::Add(hn::Add(number(f_.error_foot), hn::Mul(stretch, error)),
                               hn::Mul(far, hn::Add(up, number(8 * 0x1p-53))));
    return hn::Mul(number(2), hn::Add(sum, number(8 * 0x1p-53 * (std::abs(f_.foot.x) + std::abs(f_.foot.y)))));
  }

  const PlacesFrame& f_;
};

void place_side_by_side_here(const PlacesFrame& frame, WidePlaces& places) {
  const SideBySide side_by_side(frame);
  for (std::size_t i = 0; i < places.count; i += hn::Lanes(Doubles())) side_by_side(places, i);
}

}  // namespace
}  // namespace penumbra::volumes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::volumes {

HWY_EXPORT(place_side_by_side_here);

void place_side_by_side(const PlacesFrame& frame, WidePlaces& places) {
  HWY_DYNAMIC_DISPATCH(place_side_by_side_here)(frame, places);
}

}  // namespace penumbra::volumes
#endif
