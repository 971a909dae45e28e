#pragma once

#include "visibility/method.hpp"

#include <memory>

namespace penumbra::volumes {

/// How the shares of a light that different occluders hide, each found as if it were alone, become one (course notes,
/// 1.3). max ≤ what is hidden ≤ sum, if each share is right.
enum class Fusion {
  sum,      ///< as if none hid what another hides
  max,      ///< as if all hid what the darkest one hides
  product,  ///< as if they hid independently of one another
  average,  ///< the middle between max and sum
};

/// Accumulates what occluders hide from one view sample; `whole` is V without occluders, `hidden` an occluder's share
/// of it.
class FusedShare {
 public:
  void add(double hidden, double whole) {
    largest_ = hidden > largest_ ? hidden : largest_;
    sum_ += hidden;
    rest_ *= whole > 0 ? 1 - hidden / whole : 0;
  }
  /// V.
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

/// U. Assarsson, M. Dougherty, M. Mounier, T. Akenine-Möller 2003: asks `alone`, a method for planar lights that adds
/// what occluders hide, for each object of the scene by itself, and fuses what they hide, in each of the light's parts.
struct FusedOptions {
  Fusion rule = Fusion::sum;
  std::uint32_t split = 1;
};
std::unique_ptr<visibility::Method> make_fused(visibility::MethodDescription description,
                                               std::unique_ptr<visibility::Method> alone, const FusedOptions& options);

}  // namespace penumbra::volumes
