// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmpxx.h>

#include <array>

// Vectors of integers of unlimited size. Internal to areas/.

namespace penumbra::areas {

using Integers = std::array<mpz_class, 3>;

inline Integers difference(const Integers& a, const Integers& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline Integers cross(const Integers& a, const Integers& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline mpz_class dot(const Integers& a, const Integers& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline mpz_class determinant(const Integers& a, const Integers& b, const Integers& c) {
  return dot(a, cross(b, c));
}

}  // namespace penumbra::areas
