// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/fuzz/soup_case.hpp"

#include <gmpxx.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace penumbra::fuzz {

/// Computes the truth of every pair of a case, from its definition and the stored floats alone, in integers of any
/// size. It shares no arithmetic with the program, so that it can check the methods and visibility::decide_pair.
class SoupJudge {
 public:
  explicit SoupJudge(const SoupCase& judged);

  /// Returns whether the view sample of this pixel, which must not be background, sees the light sample.
  [[nodiscard]] bool sees(std::size_t pixel, std::uint32_t light_sample) const;

 private:
  /// Coordinates, multiplied by one power of two that makes all of a case's coordinates integers.
  using Point = std::array<mpz_class, 3>;
  struct Caster {
    std::array<Point, 3> corners;
    std::vector<int> side_of_light_sample;
  };

  [[nodiscard]] Point exactly(const glm::vec3& x) const;
  [[nodiscard]] std::array<Point, 3> corners_of(std::uint32_t triangle) const;
  /// Returns the sign of (p, l; a b); zeros are decided with l moved to l + ε·u + ε²·v.
  [[nodiscard]] int edge_sign(const Point& p, const Point& l, const Point& a, const Point& b) const;

  const SoupCase& case_;
  int exponent_ = 0;  ///< the power of two is its negative
  Point center_, u_, v_;
  std::vector<Point> light_points_;
  std::vector<Caster> casters_;
};

}  // namespace penumbra::fuzz
