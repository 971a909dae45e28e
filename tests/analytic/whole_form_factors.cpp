// SPDX-License-Identifier: Apache-2.0
// Tests that form factors of whole lights, and of their parts, are the same bits computed side by side and one at a
// time, on every vector width, even near an edge, a plane or the horizon. Also compares the arc tangent of both with
// the x87's.
#include "tests/unit/visibility/scenes.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/lights/angle_over_sine.hpp"
#include "visibility/lights/part_form_factors.hpp"
#include "visibility/lights/unshadowed_light.hpp"
#include "visibility/lights/whole_form_factors.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace penumbra::visibility {
namespace {

/// Elements on a lattice that contains the lights' corners, planes and axes, and elements anywhere.
struct Surroundings {
  std::vector<glm::vec3> p, n;
  std::vector<std::uint32_t> which;
};

Surroundings surroundings(std::mt19937& random, std::size_t count) {
  std::uniform_real_distribution<float> far(-4, 4);
  const auto lattice = [&] { return static_cast<float>(static_cast<int>(random() % 9) - 4) / 2; };
  Surroundings all;
  while (all.p.size() < count) {
    const bool anywhere = all.p.size() % 3 == 0;
    const auto place = [&] { return anywhere ? far(random) : lattice(); };
    const glm::vec3 p(place(), place(), place()), n(place(), place(), place());
    if (n == glm::vec3(0)) continue;
    all.p.push_back(p);
    all.n.push_back(anywhere ? glm::normalize(n) : n);
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    if (i % 7 != 5) all.which.push_back(i);
  }
  return all;
}

Light light_on_lattice(const std::string& kind, bool two_sided) {
  scenes::AreaLight source = tests::rectangle_light({0, 1, 0}, {0.5, 0, 0}, {0, 0.5, 1});
  if (kind == "polygon")
    source.shape = scenes::Polygon{{{1, 1, 0}, {0.5, 1, 1}, {-1, 1, 0.5}, {-0.75, 1, -1}, {0, 1, -1}}};
  if (kind == "disk") source.shape = scenes::Disk{{0, 1, 0}, {0.5, -1, 0}, 0.75};
  if (kind == "ellipse") source.shape = scenes::Ellipse{{0, 1, 0}, {0.5, 0.1, 0}, {0.1, 0, 0.9}};
  if (kind == "sphere") source.shape = scenes::Sphere{{0, 1, 0}, 0.5};
  if (kind == "sun") source.shape = scenes::Sun{{0.5, -1, 0.25}, 40};
  if (kind == "hard sun") source.shape = scenes::Sun{{0.5, -1, 0.25}, 0};
  source.two_sided = two_sided;
  scenes::Scene scene;
  scene.lights.push_back(source);
  return make_light(scene, 0, glm::dvec3(0), {1});
}

class WholeFormFactors : public testing::TestWithParam<const char*> {
 protected:
  void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};

TEST_P(WholeFormFactors, AreThoseOfOneElementToTheLastBitOnEveryWidth) {
  constexpr unsigned kSeed = 5;
  std::mt19937 random(kSeed);
  const std::string kind = GetParam();
  for (const bool two_sided : {false, true}) {
    if (two_sided && (kind == "sphere" || kind.ends_with("sun"))) continue;
    const Surroundings all = surroundings(random, 3001);
    const Light light = light_on_lattice(kind, two_sided);
    std::size_t lit = 0, dark = 0;
    std::vector<double> expected;
    for (const std::uint32_t i : all.which) {
      expected.push_back(UnshadowedLight(light, all.p[i], all.n[i]).whole());
      ++(expected.back() > 0 ? lit : dark);
    }
    EXPECT_GT(lit, expected.size() / 16);
    EXPECT_GT(dark, expected.size() / 16);
    const std::int64_t can = hwy::SupportedTargets();
    for (std::int64_t targets = can; targets != 0; targets &= targets - 1) {
      hwy::SetSupportedTargetsForTest(targets & -targets);
      std::vector<double> found(expected.size(), -1);
      whole_form_factors(light, {all.p, all.n, all.which}, found);
      for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_EQ(std::bit_cast<std::uint64_t>(found[i] + 0.0), std::bit_cast<std::uint64_t>(expected[i] + 0.0))
            << kind << (two_sided ? ", two sides, seed " : ", seed ") << kSeed << ", element " << all.which[i]
            << ", target " << hwy::TargetName(targets & -targets) << ": " << found[i] << " and " << expected[i];
      }
      hwy::SetSupportedTargetsForTest(0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, WholeFormFactors,
                         testing::Values("rectangle", "polygon", "disk", "ellipse", "sphere", "sun", "hard sun"),
                         [](const auto& given) {
                           std::string name = given.param;
                           std::erase(name, ' ');
                           return name;
                         });

/// Makes parts on the lattice of rows=exact, between two heights; some have a side of length 0, or no area.
FourCorneredParts parts_on_lattice(std::mt19937& random, std::size_t count) {
  std::uniform_real_distribution<double> anywhere(-1, 1);
  FourCorneredParts parts;
  parts.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto place = [&] { return i % 3 == 0 ? anywhere(random) : static_cast<int>(random() % 9) / 4.0 - 1; };
    const auto [low, high] = std::minmax({place(), place()});
    const auto [left, right] = std::minmax({place(), place()});
    const auto [upper_left, upper_right] = std::minmax({place(), place()});
    parts.set(i, {glm::dvec2(left, low), {right, low}, {upper_right, high}, {upper_left, high}});
  }
  return parts;
}

class PartFormFactors : public WholeFormFactors {};

TEST_P(PartFormFactors, AreThoseOfOnePartToTheLastBitOnEveryWidth) {
  constexpr unsigned kSeed = 6;
  std::mt19937 random(kSeed);
  const std::string kind = GetParam();
  const std::int64_t can = hwy::SupportedTargets();
  std::size_t lit = 0, dark = 0, cut = 0;
  for (const bool two_sided : {false, true}) {
    const Surroundings all = surroundings(random, 600);
    const Light light = light_on_lattice(kind, two_sided);
    for (const std::uint32_t i : all.which) {
      const FourCorneredParts parts = parts_on_lattice(random, 1 + random() % 20);
      const UnshadowedLight seen(light, all.p[i], all.n[i]);
      double expected = 0;
      for (std::size_t part = 0; part < parts.size(); ++part) expected += seen.part(parts.get(part));
      ++(expected != 0 ? lit : dark);
      const UnshadowedLight::Frame frame = seen.frame();
      cut += std::abs(frame.height) < std::abs(frame.height_u) + std::abs(frame.height_v) ? 1 : 0;
      for (std::int64_t targets = can; targets != 0; targets &= targets - 1) {
        hwy::SetSupportedTargetsForTest(targets & -targets);
        const double found = sum_of_parts(seen, parts);
        ASSERT_EQ(std::bit_cast<std::uint64_t>(found + 0.0), std::bit_cast<std::uint64_t>(expected + 0.0))
            << kind << (two_sided ? ", two sides, seed " : ", seed ") << kSeed << ", element " << i << ", target "
            << hwy::TargetName(targets & -targets) << ": " << found << " and " << expected;
        hwy::SetSupportedTargetsForTest(0);
      }
    }
  }
  EXPECT_GT(lit, 200U);
  EXPECT_GT(dark, 100U);
  EXPECT_GT(cut, 100U);
}

INSTANTIATE_TEST_SUITE_P(Kinds, PartFormFactors, testing::Values("rectangle", "polygon"));

TEST(WholeFormFactor, InTheLightsPlaneThereIsNoLight) {
  // With twenty bits per coordinate a point in the light's plane is the exact sum of its axes, but the determinant in
  // double is not exact.
  constexpr unsigned kSeed = 9;
  std::mt19937 random(kSeed);
  const auto vector = [&] {
    const auto coordinate = [&] { return static_cast<double>(random() % (1U << 20U)) / (1U << 20U) - 0.5; };
    return glm::dvec3(coordinate(), coordinate(), coordinate());
  };
  for (int round = 0; round < 2000; ++round) {
    const glm::dvec3 u = vector(), v = vector();
    scenes::AreaLight source = tests::rectangle_light({0, 0, 0}, u, v);
    source.two_sided = true;
    scenes::Scene scene;
    scene.lights.push_back(source);
    const Light light = make_light(scene, 0, glm::dvec3(0), {1});
    // Points beside the light in its plane; their normals lean toward its emitting side.
    const std::vector<glm::vec3> p{glm::vec3(2.0 * u), glm::vec3(2.0 * u + v), glm::vec3(u + 2.0 * v),
                                   glm::vec3(-2.0 * v)};
    std::vector<glm::vec3> n;
    for (const glm::vec3& at : p) n.push_back(glm::normalize(-at + 0.1F * glm::vec3(glm::cross(u, v))));
    const std::vector<std::uint32_t> which{0, 1, 2, 3};
    std::vector<double> found(p.size(), -1);
    whole_form_factors(light, {p, n, which}, found);
    for (std::size_t i = 0; i < p.size(); ++i)
      ASSERT_EQ(found[i], 0) << "seed " << kSeed << ", round " << round << ", element " << i;
  }
}

TEST(AngleOverSine, IsTheArcTangentToAFewRoundings) {
  if (std::numeric_limits<long double>::digits < 64) GTEST_SKIP() << "long double is no longer than double";
  // Errors in ε = 2⁻⁵³. Short edges: q is off by 2, of which the series feels a twentieth; its coefficients add 0.04,
  // its last sums 1.7, the division 1: 3 in all. Other edges: the length is off by 1; so the ratio is off by 0.5 + 3 ·
  // 0.41, and the arc by 2.8 absolutely, plus a base off by 0.3 and a sum off by at most 1. Of an angle of at least π/8
  // that is a relative error of 8.5; the length and the division add 2: 11 in all. (Larger angles have no larger
  // errors.)
  constexpr long double kEpsilon = 0x1p-53L;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> turn(0, 3.14159), scale(-40, 40);
  long double worst_short = 0, worst = 0;
  for (int i = 0; i < 400000; ++i) {
    const double angle = i % 4 == 0 ? std::exp2(scale(random) - 41) : turn(random), size = std::exp2(scale(random));
    const double sine = size * std::sin(angle), squared = sine * sine, along = size * std::cos(angle);
    const long double root = sqrtl(squared), exact = atan2l(root, along) / root;
    const long double off = std::abs((angle_over_sine(squared, along) - exact) / exact) / kEpsilon;
    long double& most = along > 0 && squared <= kArcSeriesEnd * along * along ? worst_short : worst;
    most = std::max(most, off);
  }
  RecordProperty("short", std::to_string(worst_short));
  RecordProperty("others", std::to_string(worst));
  EXPECT_LE(worst_short, 3);
  EXPECT_LE(worst, 11);
  EXPECT_GT(worst_short, 0);
  for (const double q : {0.0, 0x1p-60, 0.01, 0.1, kArcSeriesEnd}) {
    // The polynomial's own error, in long double and so without the rounding of doubles, is 2^−57.8.
    long double sum = 0;
    for (std::size_t k = kArcSeries.size(); k-- > 0;) sum = sum * q + kArcSeries[k];
    const long double root = sqrtl(q), exact = q == 0 ? 1 : atanl(root) / root;
    EXPECT_LE(std::abs(sum - exact), 0x1p-57L) << q;
  }
}

}  // namespace
}  // namespace penumbra::visibility
