// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "areas/area_sweep.hpp"
#include "visibility/lights/disk_part.hpp"

#include <gmpxx.h>

#include <algorithm>
#include <array>

// Part of a region in the unit disk, for the sweep. Internal to areas/.

namespace penumbra::areas {

/// Measures the part in the unit disk of each trapezoid between two edges (visibility::DiskPart), in double for any
/// number type of the sweep: positions of the straight edges are the sweep's, with its exactness. Off by 64 · 2⁻⁵³ for
/// each trapezoid at the rim.
template <typename Number>
class DiskMeasure {
 public:
  static constexpr bool kNeedsEnds = true;

  void add_breaks(std::vector<Number>& /*breaks*/) const {}
  void enter_strip(const Number& /*middle*/) {}
  void enter_slab(const Number& from, const Number& to) {
    from_ = to_double(from);
    to_ = to_double(to);
  }
  [[nodiscard]] Number between(const ActiveEdge<Number>& low, const ActiveEdge<Number>& high) const {
    const std::array<glm::dvec2, 4> corners{glm::dvec2(from_, to_double(low.from)),
                                            {to_, to_double(low.to)},
                                            {to_, to_double(high.to)},
                                            {from_, to_double(high.from)}};
    const bool inside = std::ranges::all_of(corners, [](const glm::dvec2& q) { return q.x * q.x + q.y * q.y <= 1; });
    if (inside) return high.t - low.t;
    if (!(to_ > from_)) return 0;
    return visibility::DiskPart(corners).area() / (to_ - from_);
  }

 private:
  static double to_double(double value) { return value; }
  static double to_double(const mpq_class& value) { return value.get_d(); }

  double from_ = 0, to_ = 0;  // the slab
};

}  // namespace penumbra::areas
