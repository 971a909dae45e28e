// SPDX-License-Identifier: Apache-2.0
// Points on a square, each in its own cell of a grid and in its own column and row of a finer grid: Kensler,
// "Correlated multi-jittered sampling" (Pixar Technical Memo 13-01, 2013), with other permutations. From the square to
// the disk: Shirley, Chiu, "A low distortion map between disk and square" (1997).

#include "visibility/lens.hpp"

#include "visibility/sample_patterns.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace penumbra::visibility {
namespace {

/// Permutes 0 … count − 1 by a key: applies invertible steps on as many bits as count has, until the result is below
/// count.
std::uint32_t permuted(std::uint32_t i, std::uint32_t count, std::uint32_t key) {
  const std::uint32_t mask = std::bit_ceil(count) - 1;
  const int half = std::max(static_cast<int>(std::bit_width(mask)) / 2, 1);
  do {
    for (std::uint32_t round = 0; round < 3; ++round) {
      const std::uint32_t bits = hash(key, round, 0);
      i = (i + bits) & mask;
      i ^= i >> half;
      i = (i * (bits >> 7 | 1u)) & mask;
      i ^= i >> half;
    }
  } while (i >= count);
  return i;
}

/// Maps the unit square to the disk; rings of the square become circles.
glm::dvec2 on_disk(const glm::dvec2& square) {
  const double a = 2 * square.x - 1, b = 2 * square.y - 1;
  if (a == 0 && b == 0) return glm::dvec2(0);
  const bool is_wide = std::abs(a) > std::abs(b);
  const double radius = is_wide ? a : b;
  const double angle = is_wide ? std::numbers::pi / 4 * (b / a) : std::numbers::pi / 2 - std::numbers::pi / 4 * (a / b);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Returns the largest divisor of `moments` up to its square root: moments divide a view sample into this many columns
/// of cells.
std::uint32_t columns_of(std::uint32_t moments) {
  std::uint32_t columns = 1;
  for (std::uint32_t i = 2; i * i <= moments; ++i) {
    if (moments % i == 0) columns = i;
  }
  return columns;
}

}  // namespace

glm::dvec2 Lens::point(std::uint32_t x, std::uint32_t y) const {
  const std::uint32_t pixel = hash(x / side, y / side, 0), in_pixel = y % side * side + x % side;
  const std::uint32_t columns = side * columns_of(moments), rows = side * moments / columns_of(moments);
  const std::uint32_t place = permuted(moment * side * side + in_pixel, columns * rows, pixel);
  const std::uint32_t column = place % columns, row = place / columns;
  const double across = permuted(row, rows, hash(pixel, 1, 0)) + to_unit(hash(pixel, place, 1)),
               upward = permuted(column, columns, hash(pixel, 2, 0)) + to_unit(hash(pixel, place, 2));
  return radius * on_disk({(column + across / rows) / columns, (row + upward / columns) / rows});
}

}  // namespace penumbra::visibility
