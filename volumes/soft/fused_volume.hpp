// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"

#include <memory>

namespace penumbra::volumes {

/// Combination of the shares of a light that different occluders hide, each computed alone (course notes, 1.3). max ≤
/// true hidden share ≤ sum, if each share is right.
enum class Fusion {
  sum,      ///< as if hidden regions never overlapped
  max,      ///< as if all hidden regions were within the largest
  product,  ///< as if they were independent
  average,  ///< the mean of max and sum
};

/// Accumulates occluders' hidden shares for one view sample; `whole` is V without occluders, `hidden` an occluder's
/// share of it.
class FusedShare {
 public:
  void add(double hidden, double whole) {
    largest_ = hidden > largest_ ? hidden : largest_;
    sum_ += hidden;
    rest_ *= whole > 0 ? 1 - hidden / whole : 0;
  }
  /// Returns V.
  [[nodiscard]] double visible(Fusion rule, double whole) const {
    const double all = sum_ < whole ? sum_ : whole;
    switch (rule) {
      case Fusion::max:
        return whole - largest_;
      case Fusion::product:
        return whole * rest_;
      case Fusion::average:
        return whole - 0.5 * (largest_ + all);
      case Fusion::sum:
        break;
    }
    return whole - all;
  }

 private:
  double largest_ = 0, sum_ = 0, rest_ = 1;
};

struct FusedOptions {
  Fusion rule = Fusion::sum;
  std::uint32_t split = 1;  ///< number of the light's parts along each axis
};

/// Makes a method that evaluates `alone`, a method for planar lights that adds hidden shares, for each object of the
/// scene separately, and fuses the results, in each of the light's parts (U. Assarsson, M. Dougherty, M. Mounier,
/// T. Akenine-Möller 2003).
std::unique_ptr<visibility::Method> make_fused(visibility::MethodDescription description,
                                               std::unique_ptr<visibility::Method> alone, const FusedOptions& options);

}  // namespace penumbra::volumes
