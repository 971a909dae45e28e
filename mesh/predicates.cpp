// SPDX-License-Identifier: Apache-2.0
// Exact orientation predicates: a floating-point filter with a derived error bound, then CGAL's exact numbers.

#include "mesh/predicates.hpp"

#include "base/assert.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/MP_Float.h>

#include <cmath>
#include <limits>

namespace penumbra::mesh {
namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;

template <typename Vector>
Point point(const Vector& v) {
  return {v.x, v.y, v.z};  // exact: floats and doubles are numbers of the kernel
}

template <typename Vector>
Side side(const Vector& a, const Vector& b, const Vector& c, const Vector& p) {
  return static_cast<Side>(CGAL::orientation(point(a), point(b), point(c), point(p)));
}

/// Returns whether the direction from v to p has a negative first non-zero coordinate; directions of lines are turned
/// so that it is positive.
bool points_back(const glm::dvec3& v, const glm::dvec3& p) {
  if (p.x != v.x) return p.x < v.x;
  return p.y != v.y ? p.y < v.y : p.z < v.z;
}

/// Returns the sign of (p − v) × (q − v) in the projection on two axes.
int turn_in_projection(const glm::dvec3& v, const glm::dvec3& p, const glm::dvec3& q, int i, int j) {
  using Point2 = CGAL::Exact_predicates_inexact_constructions_kernel::Point_2;
  return CGAL::orientation(Point2(v[i], v[j]), Point2(p[i], p[j]), Point2(q[i], q[j]));
}

}  // namespace

Side side_of_plane(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& p) {
  return side(a, b, c, p);
}

Side side_of_plane(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& p) {
  return side(a, b, c, p);
}

Side side_of_direction(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
  const glm::dvec3 u = glm::dvec3(b) - glm::dvec3(a), v = glm::dvec3(c) - glm::dvec3(a), w(d);
  const auto determinant = [](const auto& x, const auto& y, const auto& z) {
    return z.x * (x.y * y.z - x.z * y.y) + z.y * (x.z * y.x - x.x * y.z) + z.z * (x.x * y.y - x.y * y.x);
  };
  const auto size = [](const glm::dvec3& x) { return std::abs(x.x) + std::abs(x.y) + std::abs(x.z); };
  const double value = determinant(u, v, w);
  // Two differences, two products of two of them, a product, three sums, each of at most these sizes: fewer than 16
  // roundings of 2⁻⁵³. Products of three float-sized factors do not underflow below 2⁻⁵⁰⁰.
  const double error = 0x1p-49 * size(u) * size(v) * size(w);
  if (error > 0x1p-900 && std::abs(value) > error) return value > 0 ? Side::front : Side::back;
  using Exact = CGAL::MP_Float;
  struct Vector {
    Exact x, y, z;
  };
  const auto exact = [](const glm::vec3& to, const glm::vec3& from) {
    const auto one = [](double p, double q) { return Exact(p) - Exact(q); };
    return Vector{one(to.x, from.x), one(to.y, from.y), one(to.z, from.z)};
  };
  return static_cast<Side>(static_cast<int>(CGAL::sign(determinant(exact(b, a), exact(c, a), exact(d, glm::vec3(0))))));
}

bool collinear(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  // A fast filter for the answer "no".
  const glm::dvec3 u = b - a, v = c - a;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    // Each difference and product has a relative error of 2⁻⁵³, and so has their difference; products that underflow
    // are off by less than the smallest normal number. An overflow gives infinity, which fails the comparison.
    const double left = u[i] * v[j], right = u[j] * v[i];
    const double error = 0x1p-50 * (std::abs(left) + std::abs(right)) + std::numeric_limits<double>::min();
    if (std::abs(left - right) > error) return false;
  }
  return CGAL::collinear(point(a), point(b), point(c));
}

bool collinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  return collinear(glm::dvec3(a), glm::dvec3(b), glm::dvec3(c));
}

int compare_lines(const glm::dvec3& v, const glm::dvec3& p, const glm::dvec3& q) {
  // Order: by the angle in the xy plane, within (−90°, 90°] of the x axis; at equal angles by slope in z; lines along z
  // last.
  const bool p_along_z = p.x == v.x && p.y == v.y, q_along_z = q.x == v.x && q.y == v.y;
  if (p_along_z || q_along_z) return static_cast<int>(p_along_z) - static_cast<int>(q_along_z);
  const int flip = points_back(v, p) != points_back(v, q) ? -1 : 1;
  const int turn = turn_in_projection(v, p, q, 0, 1);
  return -flip * (turn != 0 ? turn : turn_in_projection(v, p, q, p.x != v.x ? 0 : 1, 2));
}

bool coplanar(const std::array<glm::vec3, 3>& carrier, const std::array<glm::vec3, 3>& other) {
  for (const glm::vec3& corner : other) {
    if (side_of_plane(carrier[0], carrier[1], carrier[2], corner) != Side::on) return false;
  }
  return true;
}

int sign_of_products(std::span<const double> x, std::span<const double> y) {
  PENUMBRA_ASSERT(x.size() == y.size(), "{} and {} numbers", x.size(), y.size());
  double sum = 0, size = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double product = x[i] * y[i];
    sum += product;
    size += std::abs(product);
  }
  // n products and n − 1 sums, each within 2⁻⁵³ of the running size: n · 2⁻⁵² bounds them all. Underflow adds at most n
  // · 2⁻¹⁰⁷⁴, far below the smallest normal number.
  const double error = static_cast<double>(x.size()) * 0x1p-52 * size + std::numeric_limits<double>::min();
  if (std::isfinite(size) && std::abs(sum) > error) return sum > 0 ? 1 : -1;
  using Exact = CGAL::MP_Float;  // sums and products of doubles without rounding
  Exact exact = 0;
  for (std::size_t i = 0; i < x.size(); ++i) exact += Exact(x[i]) * Exact(y[i]);
  return static_cast<int>(CGAL::sign(exact));
}

}  // namespace penumbra::mesh
