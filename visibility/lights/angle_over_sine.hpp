// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <numbers>

/// The term θ / sin θ of an edge in Lambert's sum: an arc tangent, in operations that IEEE 754 rounds identically
/// everywhere, so that scalar and vector code (whole_form_factors.hpp) give the same bits. Inside visibility/lights/
/// only.
namespace penumbra::visibility {

/// Coefficients of atan(√q) / √q for q up to tan²(π/8) = 3 − √8: the polynomial that interpolates it at twelve
/// Chebyshev points, coefficients rounded. The function is analytic except for q ≤ −1, so such polynomials gain a
/// factor of 25 with each term; the test measures an error of 2^−57.8.
constexpr std::array<double, 12> kArcSeries{0x1.0000000000000p+0,  -0x1.555555555552fp-2, 0x1.999999999466ap-3,
                                            -0x1.2492492259b3ep-3, 0x1.c71c70cb775cep-4,  -0x1.745cf64dcc6b8p-4,
                                            0x1.3b10f0f5b11c2p-4,  -0x1.10ea1d157f295p-4, 0x1.def9ecd69dff6p-5,
                                            -0x1.9c79c07a86155p-5, 0x1.3702ea649178dp-5,  -0x1.23b93fabb83d4p-6};
constexpr double kArcSeriesEnd = 0x1.5f619980c4337p-3;  ///< tan²(π/8), rounded up
constexpr double kArcSeriesFar = 0x1.3504f333f9de6p+1;  ///< tan(3π/8) = 1 + √2
constexpr double kPerTurn = 0.5 * std::numbers::inv_pi;

/// Even and odd terms are summed separately, which halves the chain of dependent steps.
inline double arc_series(double q) {
  const double qq = q * q;
  double even = kArcSeries[10], odd = kArcSeries[11];
  for (std::size_t i = 10; i > 0; i -= 2) {
    even = even * qq + kArcSeries[i - 2];
    odd = odd * qq + kArcSeries[i - 1];
  }
  return odd * q + even;
}

/// Returns θ / sin θ / |a| |b| for a, b with the product |a × b|² = squared > 0 and a · b = along: the factor of a × b
/// in the sum. Short edges need no root. Others are rotated by π/4 or π/2 into the range of the series, and mirrored
/// where a · b < 0. A few roundings: relative error 2⁻⁵¹ (the test derives it).
inline double angle_over_sine(double squared, double along) {
  const double square = along * along;
  if (along > 0 && squared <= kArcSeriesEnd * square) return arc_series(squared / square) / along;
  const double length = std::sqrt(squared), size = std::abs(along);
  const bool is_far = length > kArcSeriesFar * size, is_near = squared <= kArcSeriesEnd * square;
  const double ratio = (is_far    ? -size
                        : is_near ? length
                                  : length - size) /
                       (is_far    ? length
                        : is_near ? size
                                  : length + size);
  const double base = is_far ? std::numbers::pi / 2 : is_near ? 0.0 : std::numbers::pi / 4;
  const double acute = base + ratio * arc_series(ratio * ratio);
  return (along < 0 ? std::numbers::pi - acute : acute) / length;
}

}  // namespace penumbra::visibility
