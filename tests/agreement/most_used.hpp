// SPDX-License-Identifier: Apache-2.0
#pragma once

// Searches for input that uses as much as possible of a bound of error.

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>

namespace penumbra::tests {

/// Twenty numbers in [0, 1], from which a case is made one after another.
class Numbers {
 public:
  double next() { return x_.at(used_++ % x_.size()); }
  double real() { return 2 * next() - 1; }
  glm::dvec3 vector() {
    const double x = real(), y = real(), z = real();
    return {x, y, z};
  }
  /// Returns these numbers again, from the first.
  [[nodiscard]] Numbers again() const {
    Numbers numbers = *this;
    numbers.used_ = 0;
    return numbers;
  }
  static Numbers at_random(std::mt19937& random) {
    Numbers numbers;
    for (double& x : numbers.x_) x = unit(random);
    return numbers;
  }
  /// Returns these numbers with one to three of them changed, mostly by little.
  [[nodiscard]] Numbers changed(std::mt19937& random) const {
    Numbers numbers = again();
    for (auto count = 1 + random() % 3; count > 0; --count) {
      double& x = numbers.x_.at(random() % x_.size());
      x = random() % 4 == 0
              ? unit(random)
              : std::clamp(x + (unit(random) - 0.5) * std::exp2(-static_cast<double>(random() % 20)), 0.0, 1.0);
    }
    return numbers;
  }

 private:
  static double unit(std::mt19937& random) { return std::uniform_real_distribution<double>(0, 1)(random); }

  std::array<double, 20> x_{};
  std::size_t used_ = 0;
};

/// Returns the numbers with the largest `use(numbers)`: tries random ones `tries` times, and then as many changes of
/// the best so far.
template <typename Use>
Numbers most_used(std::mt19937& random, int tries, Use use) {
  Numbers best = Numbers::at_random(random);
  double most = use(best);
  for (int i = 1; i < 2 * tries; ++i) {
    const Numbers numbers = i < tries ? Numbers::at_random(random) : best.changed(random);
    const double used = use(numbers);
    if (used <= most) continue;
    most = used;
    best = numbers;
  }
  return best.again();
}

}  // namespace penumbra::tests
