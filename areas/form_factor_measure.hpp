// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "areas/area_sweep.hpp"
#include "areas/form_factor_sum.hpp"

#include <gmpxx.h>

#include <utility>
#include <vector>

// Form factors summed during the sweep. Internal to areas/.

namespace penumbra::areas {

/// A measure for the sweep (area_sweep.hpp) that has the results of `Measure`, and also passes each trapezoid to a
/// FormFactorSum.
template <typename Number, typename Measure>
class FormFactorMeasure {
 public:
  static constexpr bool kNeedsEnds = true;

  FormFactorMeasure(Measure measure, FormFactorSum& sum) : measure_(std::move(measure)), sum_(&sum) {}

  void add_breaks(std::vector<Number>& breaks) const { measure_.add_breaks(breaks); }
  void enter_strip(const Number& middle) { measure_.enter_strip(middle); }
  void enter_slab(const Number& from, const Number& to) {
    measure_.enter_slab(from, to);
    sum_->enter_slab(to_double(from), to_double(to));
  }
  [[nodiscard]] Number between(const ActiveEdge<Number>& low, const ActiveEdge<Number>& high) const {
    sum_->add_between(side(low), side(high));
    return measure_.between(low, high);
  }

 private:
  static double to_double(double value) { return value; }
  static double to_double(const mpq_class& value) { return value.get_d(); }
  static FormFactorSum::Side side(const ActiveEdge<Number>& edge) {
    return {edge.edge, to_double(edge.from), to_double(edge.to)};
  }

  Measure measure_;
  FormFactorSum* sum_;
};

}  // namespace penumbra::areas
