// SPDX-License-Identifier: Apache-2.0
// Tests the exact pair decision against the sentence of docs/definitions.md, evaluated literally in GMP's rationals:
// the light point is moved by ε·u + ε²·v with an ε small enough for the lattice, the crossing point with the triangle's
// plane is computed, and its barycentric coordinates decide whether it is on the triangle. Coordinates come from a tiny
// lattice, so that edges through the segment, points on planes, doubled and zero-area triangles are the normal case.

#include "visibility/pair_truth.hpp"

#include "tests/property/literal_truth.hpp"
#include "tests/unit/visibility/scenes.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <random>

namespace penumbra::visibility {
namespace {

using namespace tests::rational;
using tests::ExactTriangle;

/// Lattice coordinates are multiples of 2⁻⁴ below 2⁴: no nonzero determinant is closer to zero than 2⁻¹².
const Rational kEpsilon(1, mpz_class("1000000000000000000000000000000"));

bool meets(const glm::vec3& p, const Vector& l, const std::array<glm::vec3, 3>& corners, const Light& light,
           const Rational& epsilon) {
  const Vector u = exact(light.center_u) - exact(light.center), v = exact(light.center_v) - exact(light.center);
  return tests::meets({exact(p), l + epsilon * u + epsilon * epsilon * v - exact(p), l - exact(p), true}, corners);
}

bool meets(const glm::vec3& p, const glm::vec3& l, const std::array<glm::vec3, 3>& corners, const Light& light,
           const Rational& epsilon) {
  return meets(p, exact(l), corners, light, epsilon);
}

bool on_light_plane(const Light& light, const glm::vec3& p) {
  return ExactTriangle({light.center, light.center_u, light.center_v}).height(exact(p)) == 0;
}

class Lattice {
 public:
  explicit Lattice(std::uint32_t seed) : random_(seed) {}
  int number(int lowest, int highest) { return std::uniform_int_distribution<int>(lowest, highest)(random_); }
  glm::vec3 point() { return {number(-2, 2), number(-2, 2), number(-2, 2)}; }

  /// A rectangle light whose frame is on the lattice, with 2 × 2 samples on a lattice of half the spacing.
  Light light() {
    scenes::Scene scene;
    for (;;) {
      scene.lights = {tests::rectangle_light(point(), point(), point())};
      const auto& shape = std::get<scenes::Rectangle>(scene.lights[0].shape);
      const Vector u = exact(glm::vec3(shape.half_u)), v = exact(glm::vec3(shape.half_v));
      if (!is_zero(cross(u, v))) break;
    }
    scene.lights[0].two_sided = number(0, 1) == 1;
    return make_light(scene, 0, glm::dvec3(0), {0, 2, 2, SamplePattern::grid, 0});
  }

  /// A light sample, or the light's centre: lattice points give more zeros.
  glm::vec3 on(const Light& light) {
    const auto j = static_cast<std::size_t>(number(0, 7));
    return j < 4 ? light.points[j] : light.center;
  }

 private:
  std::mt19937 random_;
};

class PairTruthOnLattice : public testing::TestWithParam<std::uint32_t> {};

TEST_P(PairTruthOnLattice, SegmentAgainstOneTriangle) {
  Lattice lattice(GetParam());
  int met = 0, zeros = 0, zeros_met = 0;
  for (int round = 0; round < 1500; ++round) {
    const Light light = lattice.light();
    const glm::vec3 p = lattice.point(), l = lattice.on(light);
    if (on_light_plane(light, p))
      continue;  // condition (2) of docs/definitions.md excludes these pairs before any triangle is tested
    const std::array<glm::vec3, 3> corners = {lattice.point(), lattice.point(), lattice.point()};
    const Meeting meeting = segment_meets_triangle(p, l, corners, light);
    ASSERT_EQ(meeting.meets, meets(p, l, corners, light, kEpsilon)) << "round " << round;
    if (!meeting.zero_predicate) {
      ASSERT_EQ(meeting.meets, meets(p, l, corners, light, -kEpsilon))
          << "without a zero predicate, the direction of the perturbation must not matter";
    }
    const std::array<glm::vec3, 3> turned = {corners[2], corners[1], corners[0]};
    ASSERT_EQ(segment_meets_triangle(p, l, turned, light).meets, meeting.meets) << "round " << round;
    met += meeting.meets ? 1 : 0;
    zeros += meeting.zero_predicate ? 1 : 0;
    zeros_met += meeting.meets && meeting.zero_predicate ? 1 : 0;
  }
  EXPECT_GT(met, 10);
  EXPECT_GT(zeros, 50);
  EXPECT_GT(zeros_met, 5);
}

/// Points of the light's plane that are not floats: the same definition, for the part of a triangle between p and that
/// plane.
TEST_P(PairTruthOnLattice, PointsOfTheLightsPlane) {
  Lattice lattice(GetParam() + 700);
  int met = 0;
  for (int round = 0; round < 800; ++round) {
    const Light light = lattice.light();
    const glm::vec3 p = lattice.point();
    if (on_light_plane(light, p)) continue;
    const std::array<glm::vec3, 3> corners = {lattice.point(), lattice.point(), lattice.point()};
    // Multiples of 1/8, for ties; or numbers with all 53 digits.
    const double unit = round % 2 == 0 ? 0.125 : 0.1234567890123456;
    const glm::dvec2 st(unit * lattice.number(-8, 8), unit * lattice.number(-8, 8));
    const Vector c = exact(light.center), u = exact(light.center_u) - c, v = exact(light.center_v) - c;
    const Vector l = c + Rational(st.x) * u + Rational(st.y) * v;
    const PlanePoint point(light, st);
    ASSERT_LE(glm::length(glm::dvec3(l[0].get_d(), l[1].get_d(), l[2].get_d()) - point.rounded), point.off);
    const bool expected = meets(p, l, corners, light, kEpsilon);
    ASSERT_EQ(meets_before_light(p, point, corners, light), expected) << "round " << round;
    met += expected ? 1 : 0;
  }
  EXPECT_GT(met, 10);
}

TEST_P(PairTruthOnLattice, ASplitTriangleIsMetExactlyWhenTheWholeIs) {
  // A point on the triangle splits it into three: the symbolic perturbation must assign every segment through an inner
  // edge or the inner vertex to exactly one of them, or pictures would have cracks.
  Lattice lattice(GetParam() + 500);
  for (int round = 0; round < 800; ++round) {
    const Light light = lattice.light();
    const glm::vec3 p = lattice.point(), l = lattice.on(light);
    if (on_light_plane(light, p)) continue;
    const glm::vec3 a = lattice.point(), b = lattice.point(), c = lattice.point();
    const glm::vec3 inner = 0.5f * a + 0.25f * b + 0.25f * c;
    int parts = 0;
    for (const auto& part : {std::array{a, b, inner}, std::array{b, c, inner}, std::array{c, a, inner}}) {
      parts += segment_meets_triangle(p, l, part, light).meets ? 1 : 0;
    }
    ASSERT_EQ(parts, segment_meets_triangle(p, l, {a, b, c}, light).meets ? 1 : 0) << "round " << round;
  }
}

TEST_P(PairTruthOnLattice, WholePairs) {
  Lattice lattice(GetParam() + 1000);
  std::array<int, 4> outcomes{};
  for (int round = 0; round < 150; ++round) {
    scenes::Scene scene;
    std::vector<tests::Corners> soup(static_cast<std::size_t>(lattice.number(1, 12)));
    for (tests::Corners& corners : soup) corners = {lattice.point(), lattice.point(), lattice.point()};
    soup.push_back({glm::dvec3(-2), glm::dvec3(2), glm::dvec3(2, 2, -2)});  // keeps the origin at 0
    tests::add_object(scene, "soup", soup);
    const SceneFloats floats = make_scene_floats(scene);
    const Light light = lattice.light();

    ViewSamples samples;
    for (std::uint32_t carrier = 0; carrier < soup.size(); ++carrier) {
      if (floats.plane[carrier] == SceneFloats::kNoPlane) continue;
      const auto [a, b, c] = floats.corners(carrier);
      const std::array<glm::vec3, 4> places = {a, 0.5f * a + 0.5f * b, 0.25f * a + 0.25f * b + 0.5f * c,
                                               lattice.point()};
      samples.triangle.push_back(static_cast<std::int32_t>(carrier));
      samples.p.push_back(
          places[static_cast<std::size_t>(lattice.number(0, 3))]);  // rounding may move p off the carrier
      samples.facing.push_back(lattice.number(0, 1) == 0 ? std::int8_t{-1} : std::int8_t{1});
    }
    for (std::size_t pixel = 0; pixel < samples.size(); ++pixel) {
      const auto carrier = static_cast<std::uint32_t>(samples.triangle[pixel]);
      const ExactTriangle own(floats.corners(carrier)), frame({light.center, light.center_u, light.center_v});
      const glm::vec3 p = samples.p[pixel];
      for (std::uint32_t j = 0; j < light.sample_count(); ++j) {
        const glm::vec3 l = light.points[j];
        const Rational in_front = frame.height(exact(p));
        PairOutcome expected = PairOutcome::visible;
        if (own.height(exact(l)) * samples.facing[pixel] <= 0) {
          expected = PairOutcome::horizon;
        } else if (in_front == 0 || (in_front < 0 && !light.two_sided)) {
          expected = PairOutcome::behind;
        } else {
          for (std::uint32_t other = 0; other < soup.size(); ++other) {
            const ExactTriangle triangle(floats.corners(other));
            const bool coplanar =
                own.height(triangle.a) == 0 && own.height(triangle.b) == 0 && own.height(triangle.c) == 0;
            if (!coplanar && meets(p, l, floats.corners(other), light, kEpsilon)) expected = PairOutcome::blocked;
          }
        }
        const PairTruth truth = decide_pair(floats, samples, pixel, light, j);
        ASSERT_EQ(truth.outcome, expected) << "round " << round << " pixel " << pixel << " sample " << j;
        ++outcomes[static_cast<std::size_t>(truth.outcome)];
      }
    }
  }
  for (const int count : outcomes) EXPECT_GT(count, 100);
}

INSTANTIATE_TEST_SUITE_P(Seeds, PairTruthOnLattice, testing::Range(0u, 8u));

TEST(PairTruth, SphereLightDecidesZerosToo) {
  // A fan whose edges all pass through the segment: exactly one of its triangles is met.
  scenes::Scene scene;
  scene.lights.emplace_back();
  scene.lights[0].shape = scenes::Sphere{{0, 0, 4}, 0.5};
  const Light light = make_light(scene, 0, glm::dvec3(0), {1, 0, 0, SamplePattern::grid, 0});
  const glm::vec3 p(0, 0, -4);
  glm::vec3 l;
  light_points_for(light, p, &l);
  ASSERT_EQ(l, glm::vec3(0, 0, 4 - 0x1p-5f));  // the centre of the disk that p sees, nearer by r² / d
  const std::array<glm::vec3, 5> ring = {glm::vec3(1, 0, 0), glm::vec3(1, 2, 0), glm::vec3(-1, 1, 0),
                                         glm::vec3(-2, -1, 0), glm::vec3(0, -1, 0)};
  int met = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    const Meeting meeting = segment_meets_triangle(p, l, {glm::vec3(0), ring[i], ring[(i + 1) % 5]}, light);
    met += meeting.meets ? 1 : 0;
    EXPECT_TRUE(!meeting.meets || meeting.zero_predicate);
  }
  EXPECT_EQ(met, 1);
}

}  // namespace
}  // namespace penumbra::visibility
