// SPDX-License-Identifier: Apache-2.0
#pragma once

// Literal truth: does a segment from p meet a triangle? Evaluated in GMP's rationals: another library and another
// formula than the program's predicates. The point where the segment crosses the triangle's plane is computed; it is on
// the triangle if it is on the inner side of each edge.

#include <glm/vec3.hpp>
#include <gmpxx.h>

#include <array>

namespace penumbra::tests {
namespace rational {

using Rational = mpq_class;
using Vector = std::array<Rational, 3>;

template <typename Point>
Vector exact(const Point& v) {
  return {Rational(v.x), Rational(v.y), Rational(v.z)};
}
inline Vector operator-(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vector operator+(const Vector& a, const Vector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vector operator*(const Rational& s, const Vector& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
inline Rational dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline bool is_zero(const Vector& a) {
  return a[0] == 0 && a[1] == 0 && a[2] == 0;
}

}  // namespace rational

struct ExactTriangle {
  using Vector = rational::Vector;

  explicit ExactTriangle(const std::array<glm::vec3, 3>& corners)
      : a(rational::exact(corners[0])), b(rational::exact(corners[1])), c(rational::exact(corners[2])) {
    using namespace rational;
    normal = cross(b - a, c - a);
  }
  Vector a, b, c, normal;
  [[nodiscard]] rational::Rational height(const Vector& q) const {
    using namespace rational;
    return dot(normal, q - a);
  }
};

/// p + t · direction, with 0 < t < 1, or 0 < t if the light is infinitely far away.
struct ExactSegment {
  rational::Vector p, direction;
  rational::Vector straight;  ///< the direction before ties were moved aside: a triangle whose plane holds the end of
                              ///< that segment is not met
  bool ends = true;
};

inline bool meets(const ExactSegment& from_p, const std::array<glm::vec3, 3>& corners) {
  using namespace rational;
  const ExactTriangle triangle(corners);
  const Rational at_p = triangle.height(from_p.p), straight = dot(triangle.normal, from_p.straight);
  const Rational at_end = from_p.ends ? Rational(at_p + straight) : straight;
  if (is_zero(triangle.normal) || at_p == 0 || at_end == 0) return false;
  const Rational rise = dot(triangle.normal, from_p.direction);
  if (rise == 0) return false;
  const Rational t = -at_p / rise;
  if (t <= 0 || (from_p.ends && t >= 1)) return false;
  const Vector q = from_p.p + t * from_p.direction;
  return dot(cross(triangle.b - q, triangle.c - q), triangle.normal) >= 0 &&
         dot(cross(triangle.c - q, triangle.a - q), triangle.normal) >= 0 &&
         dot(cross(triangle.a - q, triangle.b - q), triangle.normal) >= 0;
}

}  // namespace penumbra::tests
