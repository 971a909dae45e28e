// SPDX-License-Identifier: Apache-2.0
// Tests whole pairs of spheres and suns against the sentence of docs/definitions.md, in rationals: soups on a tiny
// lattice, with view samples on corners and edges and inside the light.

#include "tests/property/literal_truth.hpp"
#include "tests/unit/visibility/scenes.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/tree/pair_judge.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

namespace penumbra::visibility {
namespace {

using namespace tests::rational;
using tests::ExactTriangle;

/// Light points are floats of 24 bits: this is far below every nonzero determinant of them and lattice points.
const Rational kInfinitesimal(1, mpz_class("1" + std::string(90, '0')));

class Numbers {
 public:
  explicit Numbers(std::uint32_t seed) : random_(seed) {}
  int number(int lowest, int highest) { return std::uniform_int_distribution<int>(lowest, highest)(random_); }
  glm::vec3 point(int reach) {
    const int x = number(-reach, reach), y = number(-reach, reach), z = number(-reach, reach);
    return {x, y, z};
  }

 private:
  std::mt19937 random_;
};

/// For one kind of light, taken literally: condition (2) of docs/definitions.md, and the axes along which ties are
/// moved.
struct Reading {
  bool in_front = true;
  Vector u, v;
};

Reading read(const Light& light, const glm::vec3& p) {
  Reading reading;
  if (light.sun) {
    reading.u = exact(light.sun->axis_u);
    reading.v = exact(light.sun->axis_v);
    return reading;
  }
  const LightFrame frame = light_frame_from(light, p);
  reading.u = exact(frame.u);
  reading.v = exact(frame.v);
  const Vector q = exact(p) - exact(light.center);
  reading.in_front = dot(q, q) > Rational(light.radius) * Rational(light.radius);
  return reading;
}

ViewSamples samples_of(const SceneFloats& floats, std::size_t triangles, Numbers& numbers) {
  ViewSamples samples;
  for (std::uint32_t carrier = 0; carrier < triangles; ++carrier) {
    if (floats.plane[carrier] == SceneFloats::kNoPlane) continue;
    const auto [a, b, c] = floats.corners(carrier);
    const std::array<glm::vec3, 4> places = {a, 0.5f * a + 0.5f * b, 0.25f * a + 0.25f * b + 0.5f * c,
                                             numbers.point(2)};
    samples.triangle.push_back(static_cast<std::int32_t>(carrier));
    samples.p.push_back(places[static_cast<std::size_t>(numbers.number(0, 3))]);
    samples.facing.push_back(numbers.number(0, 1) == 0 ? std::int8_t{-1} : std::int8_t{1});
  }
  return samples;
}

PairOutcome literal_outcome(const SceneFloats& floats, const ViewSamples& samples, std::size_t pixel,
                            const Light& light, const glm::vec3& l) {
  const glm::vec3& p = samples.p[pixel];
  const Reading reading = read(light, p);
  if (!reading.in_front) return PairOutcome::behind;
  const ExactTriangle own(floats.corners(static_cast<std::uint32_t>(samples.triangle[pixel])));
  const bool ends = !light.sun;  // a sun's light point is itself a direction
  const Rational above = ends ? own.height(exact(l)) : dot(own.normal, exact(l));
  if (above * samples.facing[pixel] <= 0) return PairOutcome::horizon;
  const Vector straight = ends ? exact(l) - exact(p) : exact(l);
  const Vector moved = straight + kInfinitesimal * reading.u + kInfinitesimal * kInfinitesimal * reading.v;
  for (std::uint32_t other = 0; other < floats.triangles.size(); ++other) {
    if (floats.casts_shadow[other] == 0) continue;
    const ExactTriangle triangle(floats.corners(other));
    const bool coplanar = own.height(triangle.a) == 0 && own.height(triangle.b) == 0 && own.height(triangle.c) == 0;
    if (!coplanar && tests::meets({exact(p), moved, straight, ends}, floats.corners(other)))
      return PairOutcome::blocked;
  }
  return PairOutcome::visible;
}

void expect_literal(const scenes::LightShape& shape, Numbers& numbers, std::array<int, 4>& outcomes, int& zeros) {
  scenes::Scene scene;
  std::vector<tests::Corners> soup(static_cast<std::size_t>(numbers.number(1, 12)));
  for (tests::Corners& corners : soup)
    corners = {glm::dvec3(numbers.point(2)), glm::dvec3(numbers.point(2)), glm::dvec3(numbers.point(2))};
  soup.push_back({glm::dvec3(-2), glm::dvec3(2), glm::dvec3(2, 2, -2)});  // keeps the origin at 0
  tests::add_object(scene, "soup", soup);
  scene.lights.emplace_back();
  scene.lights[0].shape = shape;
  const SceneFloats floats = make_scene_floats(scene);
  const Light light = make_light(scene, 0, glm::dvec3(0), {0, 3, 3, SamplePattern::grid, 0});
  const ViewSamples samples = samples_of(floats, soup.size(), numbers);
  std::vector<glm::vec3> points(light.sample_count());
  for (std::size_t pixel = 0; pixel < samples.size(); ++pixel) {
    light_points_for(light, samples.p[pixel], points.data());
    for (std::uint32_t j = 0; j < light.sample_count(); ++j) {
      const PairTruth truth = decide_pair(floats, samples, pixel, light, j);
      ASSERT_EQ(truth.outcome, literal_outcome(floats, samples, pixel, light, points[j]))
          << "pixel " << pixel << " sample " << j;
      ++outcomes[static_cast<std::size_t>(truth.outcome)];
      zeros += truth.zero_predicate ? 1 : 0;
    }
  }
}

class PairKinds : public testing::TestWithParam<std::uint32_t> {};

TEST_P(PairKinds, Spheres) {
  Numbers numbers(GetParam());
  std::array<int, 4> outcomes{};
  int zeros = 0;
  for (int round = 0; round < 40; ++round) {
    const glm::dvec3 center(numbers.point(3));
    expect_literal(scenes::Sphere{center, 0.5 * numbers.number(1, 5)}, numbers, outcomes, zeros);
    if (HasFatalFailure()) FAIL() << "seed " << GetParam() << " round " << round;
  }
  for (const int count : outcomes) EXPECT_GT(count, 50);
  EXPECT_GT(zeros, 20);
}

TEST_P(PairKinds, Suns) {
  Numbers numbers(GetParam() + 100);
  std::array<int, 4> outcomes{};
  int zeros = 0;
  for (int round = 0; round < 40; ++round) {
    glm::dvec3 direction(numbers.point(2));
    if (direction == glm::dvec3(0)) direction.y = -1;
    static constexpr std::array kAngles{0.0, 0.53, 30.0, 90.0, 150.0};
    const double angle = kAngles[static_cast<std::size_t>(numbers.number(0, 4))];
    expect_literal(scenes::Sun{direction, angle}, numbers, outcomes, zeros);
    if (HasFatalFailure()) FAIL() << "seed " << GetParam() << " round " << round;
  }
  EXPECT_EQ(outcomes[static_cast<std::size_t>(PairOutcome::behind)], 0);
  for (const PairOutcome outcome : {PairOutcome::visible, PairOutcome::blocked, PairOutcome::horizon})
    EXPECT_GT(outcomes[static_cast<std::size_t>(outcome)], 200);
  EXPECT_GT(zeros, 40);
}

/// The tree of boxes skips no triangle that a ray meets.
TEST_P(PairKinds, SunsAlongTheTree) {
  Numbers numbers(GetParam() + 200);
  int differing = 0, visible = 0, pairs = 0;
  for (int round = 0; round < 20; ++round) {
    scenes::Scene scene;
    std::vector<tests::Corners> soup(60);
    for (tests::Corners& corners : soup) {
      const glm::dvec3 at = 3.0 * glm::dvec3(numbers.point(4));
      corners = {at + glm::dvec3(numbers.point(2)), at + glm::dvec3(numbers.point(2)),
                 at + glm::dvec3(numbers.point(2))};
    }
    tests::add_object(scene, "soup", soup);
    scene.lights.emplace_back();
    glm::dvec3 direction(numbers.point(2));
    if (direction == glm::dvec3(0)) direction.y = -1;
    scene.lights[0].shape = scenes::Sun{direction, round % 2 == 0 ? 0.0 : 60.0};
    const SceneFloats floats = make_scene_floats(scene);
    const Light light = make_light(scene, 0, floats.origin, {0, 3, 3, SamplePattern::grid, 0});
    const ViewSamples samples = samples_of(floats, soup.size(), numbers);
    const TriangleTree tree = make_triangle_tree(floats);
    const PairJudge judge{floats, tree, samples, light};
    for (std::size_t pixel = 0; pixel < samples.size(); ++pixel) {
      for (std::uint32_t j = 0; j < light.sample_count(); ++j, ++pairs) {
        const bool truth = decide_pair(floats, samples, pixel, light, j).outcome == PairOutcome::visible;
        differing += judge.is_visible(pixel, light.points[j]) != truth ? 1 : 0;
        visible += truth ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(differing, 0) << "seed " << GetParam();
  EXPECT_GT(visible, pairs / 20);
  EXPECT_LT(visible, pairs / 2);
}

INSTANTIATE_TEST_SUITE_P(Seeds, PairKinds, testing::Range(0u, 6u));

/// p is closer to a triangle than double can tell: behind p it hides no sun, in front of p it does.
TEST(PairKindsByAHair, WhatIsBehindPHidesNoSun) {
  scenes::Scene scene;
  scene.lights.emplace_back();
  scene.lights[0].shape = scenes::Sun{{0, -1, 0}, 1};
  const Light light = make_light(scene, 0, glm::dvec3(0), {1, 1, 1, SamplePattern::grid, 0});
  ASSERT_TRUE(light.sun);
  const std::array<glm::vec3, 3> triangle{glm::vec3(-1, 0, -1), glm::vec3(1, 0, -1), glm::vec3(0, 0, 2)};
  for (const float hair : {0x1p-48F, 0x1p-60F, 0x1p-100F}) {
    EXPECT_FALSE(segment_meets_triangle({0, hair, 0}, {0, 1, 0}, triangle, light).meets) << hair;
    EXPECT_TRUE(segment_meets_triangle({0, -hair, 0}, {0, 1, 0}, triangle, light).meets) << hair;
  }
}

}  // namespace
}  // namespace penumbra::visibility
