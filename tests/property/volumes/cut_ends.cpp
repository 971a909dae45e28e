// SPDX-License-Identifier: Apache-2.0
// Tests against rationals: the points where edges pass through a light's plane, and normals.

#include "tests/agreement/hostile_lamps.hpp"
#include "volumes/edges/cut_ends.hpp"
#include "volumes/edges/plane_normal.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace penumbra::volumes {
namespace {

using Rationals = std::array<mpq_class, 3>;

template <typename Point>
Rationals difference(const Point& to, const Point& from) {
  return {mpq_class(to.x) - mpq_class(from.x), mpq_class(to.y) - mpq_class(from.y),
          mpq_class(to.z) - mpq_class(from.z)};
}
Rationals cross(const Rationals& a, const Rationals& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
mpq_class dot(const Rationals& a, const Rationals& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

TEST(RoundedNormal, IsTheExactOneRounded) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> real(-1, 1);
  const auto point = [&](float size) { return size * glm::vec3(real(random), real(random), real(random)); };
  std::size_t needles = 0;
  for (int round = 0; round < 4000; ++round) {
    std::array<glm::vec3, 3> corners{point(1), point(round % 2 == 0 ? 1.0F : 600.0F), {}};
    const float width = std::ldexp(1.0F, -static_cast<int>(random() % 40));
    corners[2] = glm::mix(corners[0], corners[1], 0.3F) + point(width);
    if (round % 5 == 0) corners[2].z = corners[1].z = corners[0].z;  // some coordinates of the normal are then 0
    const Rationals n = cross(difference(corners[1], corners[0]), difference(corners[2], corners[0]));
    const glm::vec3 rounded = rounded_normal(corners);
    mpq_class largest = 0;
    for (const mpq_class& x : n) largest = std::max<mpq_class>(largest, abs(x));
    if (largest == 0) {
      EXPECT_EQ(rounded, glm::vec3(0));
      continue;
    }
    needles += width < 1e-6F ? 1 : 0;
    // All three are scaled by one power of two: that of the largest.
    const double scale = std::ldexp(1.0, -std::ilogb(largest.get_d()));
    for (std::size_t i = 0; i < 3; ++i) {
      const mpq_class exact = n[i] * mpq_class(scale), off = abs(exact - mpq_class(rounded[static_cast<int>(i)]));
      EXPECT_LE(off, abs(exact) * mpq_class(0x1p-23)) << "round " << round;
    }
  }
  EXPECT_GT(needles, 1000U);
}

/// A point on the light is within rounding of the exact one; a point far outside the light is at least on the edge's
/// line.
TEST(CutEnds, AreWhereTheEdgesPassThroughThePlane) {
  std::size_t places = 0, far = 0;
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    tests::HostileLamp lamp(tests::Hostility::panels, seed);
    const visibility::SceneFloats floats = visibility::make_scene_floats(lamp.scene());
    const visibility::Light light = visibility::make_light(lamp.scene(), 0, floats.origin, {});
    const glm::dvec3 c(light.center), u = glm::dvec3(light.center_u) - c, v = glm::dvec3(light.center_v) - c;
    const LightSide side{{c, glm::dvec3(light.center_u), glm::dvec3(light.center_v)}, c, u, v, 1, 1};
    const Rationals exact_u = difference(glm::dvec3(light.center_u), c),
                    exact_v = difference(glm::dvec3(light.center_v), c);
    const Rationals n = cross(exact_u, exact_v);
    CutEnds ends(side);
    for (const visibility::Triangle& triangle : floats.triangles) {
      const glm::vec3 a = floats.positions[triangle[0]], b = floats.positions[triangle[1]];
      if (side.place_of(a) <= 0 || side.place_of(b) > 0) continue;
      const CutEnd& end = ends[ends.of_edge(a, b, false)].b;
      const Rationals from = difference(glm::dvec3(a), c), to = difference(glm::dvec3(b), c);
      const mpq_class ha = dot(n, from), hb = dot(n, to), t = ha / (ha - hb);
      Rationals x;
      for (std::size_t i = 0; i < 3; ++i) x[i] = from[i] + t * (to[i] - from[i]);
      if (end.place) {
        ++places;
        const mpq_class s = dot(x, cross(exact_v, n)) / dot(n, n), r = dot(x, cross(n, exact_u)) / dot(n, n);
        EXPECT_DOUBLE_EQ(end.place->x, mpq_class((s + 1) / 2).get_d()) << "seed " << seed;
        EXPECT_DOUBLE_EQ(end.place->y, mpq_class((r + 1) / 2).get_d()) << "seed " << seed;
      } else {
        ++far;
        const glm::dvec3 direction = glm::dvec3(b) - glm::dvec3(a), d = end.point - glm::dvec3(a);
        EXPECT_LT(glm::length(glm::cross(direction, d)),
                  1e-13 * glm::length(direction) * (glm::length(direction) + glm::length(c)))
            << "seed " << seed;
      }
    }
  }
  EXPECT_GT(places, 100U);
  EXPECT_GT(far, 50U);
}

}  // namespace
}  // namespace penumbra::volumes
