// SPDX-License-Identifier: Apache-2.0
// Computes the exact region of a light in its own plane, and grids that convert doubles to integers.

#include "areas/light_region.hpp"

#include "areas/integer_vector.hpp"
#include "base/assert.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace penumbra::areas {
namespace {

mpq_class ratio(const mpz_class& over, const mpz_class& under) {
  mpq_class value(over, under);
  value.canonicalize();
  return value;
}

/// o = c + s u + t v + h n: s is det(o − c, v, n) / det(u, v, n), t is det(u, o − c, n) / det(u, v, n).
Region projected_outline(const visibility::Light& light) {
  IntegerGrid grid;
  for (const glm::vec3& point : {light.center, light.center_u, light.center_v}) grid.include(point);
  for (const glm::vec3& point : light.outline) grid.include(point);
  const Integers c = grid.integers(light.center), u = difference(grid.integers(light.center_u), c),
                 v = difference(grid.integers(light.center_v), c);
  const Integers n = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const mpz_class under = determinant(u, v, n);
  Region region;
  for (const glm::vec3& corner : light.outline) {
    const Integers o = difference(grid.integers(corner), c);
    region.push_back({ratio(determinant(o, v, n), under), ratio(determinant(u, o, n), under)});
  }
  if (area_of(region) < 0) std::ranges::reverse(region);
  return region;
}

}  // namespace

Region light_region(const visibility::Light& light) {
  if (is_polygon(light.kind)) return projected_outline(light);
  if (light.dome && light.dome->half) return {{-1, 0}, {1, 0}, {1, 1}, {-1, 1}};
  return {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
}

mpq_class area_of(const Region& region) {
  mpq_class doubled = 0;
  for (std::size_t i = 0; i < region.size(); ++i) {
    const PlanePoint &a = region[i], &b = region[(i + 1) % region.size()];
    doubled += a.s * b.t - a.t * b.s;
  }
  return doubled / 2;
}

Region clip(const Region& region, const HalfPlane& half_plane) {
  const mpq_class at(half_plane.at), along_s(half_plane.along_s), along_t(half_plane.along_t);
  const auto height = [&](const PlanePoint& q) { return mpq_class(at + q.s * along_s + q.t * along_t); };
  Region result;
  for (std::size_t i = 0; i < region.size(); ++i) {
    const PlanePoint &a = region[i], &b = region[(i + 1) % region.size()];
    const mpq_class at_a = height(a), at_b = height(b);
    if (at_a >= 0) result.push_back(a);
    if ((at_a >= 0) == (at_b >= 0)) continue;
    const mpq_class share = at_a / (at_a - at_b);
    result.push_back({a.s + share * (b.s - a.s), a.t + share * (b.t - a.t)});
  }
  return result;
}

GridBox box_around(const Region& region) {
  PENUMBRA_ASSERT(!region.empty(), "a box around nothing");
  PlanePoint low = region.front(), high = region.front();
  for (const PlanePoint& q : region) {
    if (q.s < low.s) low.s = q.s;
    if (q.t < low.t) low.t = q.t;
    if (q.s > high.s) high.s = q.s;
    if (q.t > high.t) high.t = q.t;
  }
  const auto floor = [](const mpq_class& value) {
    mpz_class result;
    mpz_fdiv_q(result.get_mpz_t(), mpz_class(value.get_num() * GridBox::kGrid).get_mpz_t(), value.get_den_mpz_t());
    return result;
  };
  const auto ceiling = [&](const mpq_class& value) { return mpz_class(-floor(mpq_class(-value))); };
  return {floor(low.s), ceiling(high.s), floor(low.t), ceiling(high.t)};
}

void IntegerGrid::include(double value) {
  if (value == 0) return;
  // value = ± mantissa · 2^(exponent − 1075), as IEEE 754 stores it; its lowest set bit has the value 2^lowest.
  constexpr int kMantissa = 52;
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const int exponent = static_cast<int>(bits >> kMantissa & 0x7ff);
  const std::uint64_t above = std::uint64_t{exponent != 0} << kMantissa;  // the bit that is not stored
  const int lowest =
      std::max(exponent, 1) - 1075 + std::countr_zero((bits & ((std::uint64_t{1} << kMantissa) - 1)) | above);
  bits_ = std::max(bits_, -lowest);
}

void IntegerGrid::include(const glm::vec3& point) {
  for (int axis = 0; axis < 3; ++axis) include(point[axis]);
}

void IntegerGrid::include(const IntegerGrid& other) {
  bits_ = std::max(bits_, other.bits_);
}

mpz_class IntegerGrid::integer(double value) const {
  const double scaled = std::ldexp(value, bits_);
  PENUMBRA_ASSERT(std::isfinite(scaled) && scaled == std::trunc(scaled), "{} times 2^{}", value, bits_);
  return mpz_class(scaled);
}

std::array<mpz_class, 3> IntegerGrid::integers(const glm::dvec3& point) const {
  return {integer(point.x), integer(point.y), integer(point.z)};
}

}  // namespace penumbra::areas
