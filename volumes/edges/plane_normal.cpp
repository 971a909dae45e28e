// SPDX-License-Identifier: Apache-2.0
// Normals of triangles with each coordinate rounded once from its exact value.

#include "volumes/edges/plane_normal.hpp"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>

namespace penumbra::volumes {
namespace {

/// Returns x₁ y₂ − x₂ y₁, where x and y are differences to the first corner. The error is at most the rounding to
/// float.
double minor(const std::array<glm::vec3, 3>& corners, int x, int y) {
  const glm::dvec3 a(corners[0]), e1 = glm::dvec3(corners[1]) - a, e2 = glm::dvec3(corners[2]) - a;
  const double left = e1[x] * e2[y], right = e2[x] * e1[y], value = left - right;
  // The two factors, the product and the difference are each rounded: the error is 4 · 2⁻⁵³ of the products. Where that
  // is below 2⁻²⁶ of the value, the rounding to float takes at most three quarters of the allowed error.
  if (std::abs(value) >= 0x1p-25 * (std::abs(left) + std::abs(right))) return value;
  const auto difference = [&](std::size_t corner, int axis) {
    return mpq_class(mpq_class(static_cast<double>(corners[corner][axis])) - mpq_class(a[axis]));
  };
  return mpq_class(difference(1, x) * difference(2, y) - difference(2, x) * difference(1, y)).get_d();
}

}  // namespace

glm::vec3 rounded_normal(const std::array<glm::vec3, 3>& corners) {
  const glm::dvec3 n(minor(corners, 1, 2), minor(corners, 2, 0), minor(corners, 0, 1));
  const double largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
  return largest == 0 ? glm::vec3(0) : glm::vec3(n * std::ldexp(1.0, -std::ilogb(largest)));
}

}  // namespace penumbra::volumes
