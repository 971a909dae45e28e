// SPDX-License-Identifier: Apache-2.0
// Segment–triangle test in double with a derived error bound; undecided cases are left to exact predicates.

#include "visibility/certain_meeting.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <cstddef>

namespace penumbra::visibility {
namespace {

/// Segment from p (`ends`) or ray; `off`: error of the segment's end.
struct Direction {
  glm::dvec3 direction;
  double off = 0;
  bool ends = true;
};

std::optional<bool> decide(const glm::dvec3& p, const Direction& from_p, const std::array<glm::vec3, 3>& corners) {
  const auto& [direction, off, ends] = from_p;
  const std::array d{glm::dvec3(corners[0]) - p, glm::dvec3(corners[1]) - p, glm::dvec3(corners[2]) - p};
  const std::array squared{glm::dot(d[0], d[0]), glm::dot(d[1], d[1]), glm::dot(d[2], d[2])};
  // An error of l adds as much to a determinant's error bound as a segment that is longer by 2⁴⁶ times that error.
  const double direction_length = glm::length(direction) + 0x1p46 * off,
               direction_squared = direction_length * direction_length;
  // Each difference has a relative error of 2⁻⁵³ in each coordinate, so a determinant of three has three such errors.
  // It also rounds six products of three factors, each at most the product of the rows' lengths, and their sums: in all
  // less than 16 · 2⁻⁵³ · 6 of that product. The bound is squared where nothing underflows; smaller values are not
  // certain.
  constexpr double kError = 0x1p-46 * 0x1p-46, kTiny = 0x1p-900;
  const auto sign = [](double value, double size_squared) {
    const double bound = kError * size_squared;
    return bound > kTiny && value * value > bound ? (value > 0 ? 1 : -1) : 0;
  };
  int left = 0, right = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    const int side =
        sign(glm::dot(direction, glm::cross(d[i], d[next])), direction_squared * squared[i] * squared[next]);
    left += side > 0 ? 1 : 0;
    right += side < 0 ? 1 : 0;
  }
  if (left > 0 && right > 0) return false;
  const glm::dvec3 e1 = d[1] - d[0], e2 = d[2] - d[0], n = glm::cross(e1, e2);
  // Differences of differences have errors relative to the lengths of their operands.
  const double largest = std::fmax(squared[0], std::fmax(squared[1], squared[2])), area = largest * largest;
  const int at_p = sign(-glm::dot(n, d[0]), 16 * area * largest);
  const int at_l = ends ? sign(glm::dot(n, direction - d[0]), 16 * area * (largest + direction_squared))
                        : sign(glm::dot(n, direction), 16 * area * direction_squared);
  if (at_p * at_l > 0) return false;
  if ((left < 3 && right < 3) || at_p == 0 || at_l == 0) return std::nullopt;
  return true;
}

}  // namespace

std::optional<bool> certainly_meets(const glm::dvec3& p, const glm::dvec3& l, const std::array<glm::vec3, 3>& corners,
                                    double off) {
  return decide(p, {l - p, off, true}, corners);
}

std::optional<bool> ray_certainly_meets(const glm::dvec3& p, const glm::dvec3& direction,
                                        const std::array<glm::vec3, 3>& corners) {
  return decide(p, {direction, 0, false}, corners);
}

}  // namespace penumbra::visibility
