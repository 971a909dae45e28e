// SPDX-License-Identifier: Apache-2.0
#pragma once

// Support for tests of the bounds of rows=exact: cases that a search varies, and exact numbers.

#include "tests/agreement/most_used.hpp"
#include "tests/agreement/support.hpp"
#include "volumes/scatter/vectors/rows.hpp"

#include <fmt/format.h>
#include <glm/vec3.hpp>
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>

namespace penumbra::volumes::tests_of_rows {

using Rational = std::array<mpq_class, 3>;

inline Rational rational(const glm::dvec3& x) {
  return {mpq_class(x.x), mpq_class(x.y), mpq_class(x.z)};
}
inline Rational operator-(const Rational& a, const Rational& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline mpq_class dot(const Rational& a, const Rational& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Rational cross(const Rational& a, const Rational& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline mpq_class determinant(const Rational& a, const Rational& b, const Rational& c) {
  return dot(a, cross(b, c));
}

struct Use {
  double of_bound = 0, error = 0, bound = 0;
};

/// Variables of a search: a scene of a floor and a light, p on the floor, and an edge over p.
struct Case {
  scenes::Scene scene;
  glm::vec3 p{0};
  std::array<glm::vec3, 2> edge{};
};

/// Returns an edge with one triangle; p is clearly in front of that triangle, whose plane is not p's own.
inline WideEdges in_front_of(const glm::vec3& p, const std::array<glm::vec3, 2>& edge, std::uint32_t plane) {
  WideEdges leaf{};
  const glm::vec3 n = p - edge[0];
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<glm::length_t>(i);
    leaf.a[i][0] = leaf.anchor[0][i][0] = edge[0][axis];
    leaf.b[i][0] = edge[1][axis];
    leaf.n[0][i][0] = n[axis];
  }
  leaf.plane[0][0] = leaf.plane[1][0] = plane;
  return leaf;
}

/// Returns a small floor with p on it: bounds grow with the scene's largest coordinate.
inline Case on_a_floor(const glm::dvec3& at) {
  Case of;
  of.scene.origin = glm::dvec3(0);
  const double size = 0x1p-6;
  tests::add_object(
      of.scene, "floor",
      {{at + size * glm::dvec3(-1, 0, 1), at + size * glm::dvec3(1, 0.3, 0), at + size * glm::dvec3(0, 0, -1)}});
  tests::add_object(of.scene, "another plane",
                    {{at, at + size * glm::dvec3(1, 0, 0), at + size * glm::dvec3(0, 1, 0)}});
  of.p = glm::vec3(at + size * glm::dvec3(0, 0.1, 0));
  return of;
}

inline Use search(const std::function<Case(tests::Numbers)>& make, Use (*use)(const Case&)) {
  std::mt19937 random(1);
  const tests::Numbers most =
      tests::most_used(random, 10000, [&](const tests::Numbers& numbers) { return use(make(numbers)).of_bound; });
  return use(make(most));
}

/// Prints and records how much of a bound was used: it must be less than all of it, but more than remains if
/// planted_faults cuts the bound.
inline void expect_within(const char* name, const Use& most, double planted) {
  fmt::print("{}: {:.1f} % of the bound used (off by {:.2e} cells, allowed {:.2e})\n", name, 100 * most.of_bound,
             most.error, most.bound);
  testing::Test::RecordProperty(fmt::format("percent_of_bound_{}", name), fmt::format("{:.1f}", 100 * most.of_bound));
  EXPECT_LT(most.of_bound, 1);
  EXPECT_GT(most.of_bound, planted) << "the cut of the bound in planted_faults would not be noticed";
}

}  // namespace penumbra::volumes::tests_of_rows
