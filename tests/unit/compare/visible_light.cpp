// SPDX-License-Identifier: Apache-2.0
// Tests form factors made from masks: a run is the sum of its cells, cells cover the light once, and a fully visible
// light gives the whole to the last bit, whatever the pattern and the shape.

#include "compare/visible_light.hpp"
#include "tests/unit/visibility/scenes.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

namespace penumbra::compare {
namespace {

using visibility::Light;
using visibility::SamplePattern;
using visibility::SampleRequest;
using visibility::UnshadowedLight;

using Mask = std::vector<std::uint32_t>;

constexpr double kUlp = 0x1p-52;

Light light_of(const scenes::AreaLight& source, const SampleRequest& request) {
  scenes::Scene scene;
  scene.lights.push_back(source);
  return visibility::make_light(scene, 0, glm::dvec3(0), request);
}

scenes::AreaLight shape(const char* kind) {
  scenes::AreaLight light = tests::ceiling_light(2, 0.75);
  if (kind == std::string("disk")) light.shape = scenes::Disk{{0, 2, 0}, {0.1, -1, 0.2}, 0.8};
  if (kind == std::string("ellipse")) light.shape = scenes::Ellipse{{0, 2, 0}, {0.5, 0.1, 0}, {0.1, 0, 0.9}};
  if (kind == std::string("sphere")) light.shape = scenes::Sphere{{0, 2, 0}, 0.8};
  if (kind == std::string("sun")) light.shape = scenes::Sun{{0.1, -1, 0.2}, 40};
  if (kind == std::string("polygon")) light.shape = scenes::Polygon{{{1, 2, 0}, {0, 2, 1}, {-1, 2, 0}, {0, 2, -1}}};
  return light;
}

Mask full(const Light& light) {
  Mask mask(light.words_per_mask());
  for (std::uint32_t j = 0; j < light.sample_count(); ++j) mask[j / 32] |= 1u << j % 32;
  return mask;
}

Mask random_mask(const Light& light, std::mt19937& random) {
  Mask mask(light.words_per_mask());
  bool visible = false;
  const auto every = 1 + random() % 20;
  for (std::uint32_t j = 0; j < light.sample_count(); ++j) {
    if (random() % every == 0) visible = !visible;
    if (visible) mask[j / 32] |= 1u << j % 32;
  }
  return mask;
}

/// Returns the form factor of one sample's cell in a rectangle's rows, from the light samples' own coordinates: it ends
/// half way to the neighbours.
double cell(const UnshadowedLight& seen, const Light& light, std::uint32_t row, std::uint32_t column) {
  const auto s = [&](std::uint32_t c) { return light.coordinates[row * light.columns + c].x; };
  const double low = column == 0 ? -1 : (s(column - 1) + s(column)) / 2;
  const double high = column + 1 == light.columns ? 1 : (s(column) + s(column + 1)) / 2;
  return seen.box({low, 2.0 * row / light.rows - 1}, {high, 2.0 * (row + 1) / light.rows - 1});
}

TEST(VisibleLight, ARunIsTheSumOfItsCells) {
  constexpr unsigned kSeed = 8;
  std::mt19937 random(kSeed);
  const std::array<glm::vec3, 4> points{glm::vec3(0, 0, 0), {0.7f, 1.9f, -0.7f}, {3, 1, 2}, {0.75f, 1.75f, 0.1f}};
  for (const SamplePattern pattern : {SamplePattern::rows, SamplePattern::grid}) {
    for (const auto& [rows, columns] : {std::pair{1u, 1u}, {1u, 70u}, {5u, 13u}, {16u, 16u}, {64u, 64u}}) {
      const Light light = light_of(shape("rectangle"), {0, rows, columns, pattern, 0});
      const VisibleLight visible(light);
      for (const glm::vec3& p : points) {
        const UnshadowedLight seen(light, p, {0, 1, 0});
        const Mask mask = random_mask(light, random);
        double expected = 0, all = 0;
        for (std::uint32_t j = 0; j < light.sample_count(); ++j) {
          const double f = cell(seen, light, j / columns, j % columns);
          all += f;
          if ((mask[j / 32] >> j % 32 & 1) != 0) expected += f;
        }
        // A cell's sum of four terms of up to 1/4 is off by an ulp of 1/4 or two, and there are up to 4096.
        const double rounding = 2 * kUlp * light.sample_count() + 16 * kUlp;
        EXPECT_NEAR(visible.visible({seen, p}, mask).x, expected, rounding) << "seed " << kSeed << " " << p.y;
        EXPECT_NEAR(seen.whole(), all, rounding);
        EXPECT_GT(seen.whole(), 0.001);
      }
    }
  }
}

TEST(VisibleLight, AllVisibleIsTheWholeToTheLastBit) {
  // With `slanted`, the horizon cuts the lights: then exactly the samples above it are visible.
  const glm::vec3 up(0, 1, 0), slanted = glm::normalize(glm::vec3(1, 0.02f, 0.1f));
  for (const char* kind : {"rectangle", "disk", "ellipse", "polygon", "sphere", "sun"}) {
    for (const SamplePattern pattern : {SamplePattern::rows, SamplePattern::grid, SamplePattern::sobol,
                                        SamplePattern::jittered, SamplePattern::rgss}) {
      const Light light = light_of(shape(kind), {53, 0, 0, pattern, 1});
      const VisibleLight visible(light);
      for (const glm::vec3& n : {up, slanted}) {
        const glm::vec3 p(0.25f, 0, 0);
        const UnshadowedLight seen(light, p, n);
        EXPECT_EQ(seen.above_horizon(), n == up);
        std::vector<glm::vec3> samples(light.sample_count());
        visibility::light_points_for(light, p, samples.data());
        Mask mask(light.words_per_mask());
        for (std::uint32_t j = 0; j < light.sample_count(); ++j) {
          if (glm::dot(seen.normal(), visibility::direction_to(light, p, samples[j])) > 0) mask[j / 32] |= 1u << j % 32;
        }
        EXPECT_EQ(mask == full(light), n == up);
        EXPECT_GT(seen.whole(), 0.001) << kind;
        EXPECT_EQ(visible.visible({seen, p}, mask), glm::dvec3(seen.whole())) << kind << name_of(pattern);
        EXPECT_EQ(visible.visible({seen, p}, Mask(mask.size())), glm::dvec3(0));
      }
    }
  }
}

TEST(VisibleLight, FarFromTheLightItIsVButForTheRowsEnds) {
  // Cosines and distance are the same for all cells: what is left is area. A row shifted by σ cells counts its first
  // cell 1 + σ times, its last 1 − σ.
  const Light light = light_of(shape("rectangle"), {0, 7, 9, SamplePattern::rows, 0});
  const VisibleLight visible(light);
  const glm::vec3 p(0, -3e4f, 0);
  const UnshadowedLight seen(light, p, {0, 1, 0});
  std::mt19937 random(9);
  for (int round = 0; round < 50; ++round) {
    const Mask mask = random_mask(light, random);
    const auto bit = [&](std::uint32_t row, std::uint32_t column) {
      const std::uint32_t j = row * light.columns + column;
      return static_cast<double>(mask[j / 32] >> j % 32 & 1);
    };
    double cells = 0;
    for (std::uint32_t row = 0; row < 7; ++row) {
      for (std::uint32_t column = 0; column < 9; ++column) cells += bit(row, column);
      cells += light.row_shift[row] * (bit(row, 0) - bit(row, 8));
    }
    EXPECT_NEAR(visible.visible({seen, p}, mask).x / seen.whole(), cells / 63, 1e-7);  // (size / distance)² = 3e-9
  }
}

TEST(VisibleLight, SamplesOfEveryPatternConvergeToTheHalfThatIsVisible) {
  // The visible half is x < 0 of a square light near p, so near that the two halves differ much.
  const glm::vec3 p(-0.9f, 1.4f, 0.1f);
  const Light whole = light_of(shape("rectangle"), {1});
  const UnshadowedLight seen(whole, p, {0, 1, 0});
  const double expected = seen.box({-1, -1}, {0, 1});
  ASSERT_GT(expected, 0.8 * seen.whole());
  const auto value = [&](SamplePattern pattern, std::uint32_t count) {
    const Light light = light_of(shape("rectangle"), {count, 0, 0, pattern, 3});
    Mask mask(light.words_per_mask());
    for (std::uint32_t j = 0; j < light.sample_count(); ++j) {
      if (light.points[j].x < 0) mask[j / 32] |= 1u << j % 32;
    }
    return VisibleLight(light).visible({UnshadowedLight(light, p, {0, 1, 0}), p}, mask).x;
  };
  // A grid with an even number of columns has a border between cells at x = 0: the cells of the half cover it exactly.
  EXPECT_NEAR(value(SamplePattern::grid, 16), expected, 16 * kUlp);
  for (const SamplePattern pattern : {SamplePattern::rows, SamplePattern::sobol, SamplePattern::jittered}) {
    // The error is at most the form factor of a band at x = 0, half a cell (of 64 in a row) wide for runs, one cell for
    // samples.
    EXPECT_NEAR(value(pattern, 4096), expected, seen.box({-1.0 / 32, -1}, {1.0 / 32, 1})) << name_of(pattern);
  }
}

TEST(VisibleLight, ATexturesColoursAreWeighedWithTheirSamples) {
  scenes::AreaLight source = shape("rectangle");
  source.texture = scenes::Texture{"made by hand", 2, 1, {{4, 0, 0}, {0, 0.5f, 0}}};
  const Light light = light_of(source, {0, 16, 16, SamplePattern::grid, 0});
  const VisibleLight visible(light);
  const glm::vec3 p(0.5f, 0.5f, 0.25f);
  const UnshadowedLight seen(light, p, {0, 1, 0});
  const glm::dvec3 all = visible.unshadowed({seen, p});
  // Midpoint rule on cells of size 3/32 at a distance of 1.5 or more: relative error below (size / distance)² / 6.
  EXPECT_NEAR(all.x / 4, seen.box({-1, -1}, {0, 1}), 1e-3 * all.x);
  EXPECT_NEAR(all.y * 2, seen.box({0, -1}, {1, 1}), 1e-3 * all.y);
  EXPECT_NEAR(all.x / 4 + all.y * 2, seen.whole(), 16 * kUlp);
  EXPECT_EQ(visible.visible({seen, p}, full(light)), all);
}

TEST(UnshadowedLight, OnlyFromWhereItEmits) {
  scenes::AreaLight source = shape("rectangle");
  const auto whole = [&](const glm::vec3& p, const glm::vec3& n) {
    const Light light = light_of(source, {1});
    return UnshadowedLight(light, p, n).whole();
  };
  const double below = whole({0.25f, 1, 0.5f}, {0, 1, 0});
  EXPECT_GT(below, 0.1);
  EXPECT_EQ(whole({0.25f, 3, 0.5f}, {0, -1, 0}), 0);
  EXPECT_EQ(whole({0.25f, 1, 0.5f}, {0, -1, 0}), 0);
  EXPECT_EQ(whole({0.25f, 2, 0.5f}, {0, 1, 0}), 0);
  source.two_sided = true;
  EXPECT_EQ(whole({0.25f, 3, 0.5f}, {0, -1, 0}), below);
  EXPECT_EQ(whole({0.25f, 2, 0.5f}, {0, 1, 0}), 0);
}

TEST(UnshadowedLight, OnALatticeEveryFormFactorIsOneAndPartsAddUp) {
  // Elements on edges, corners and planes of lights; edges through the element; horizons along edges.
  constexpr unsigned kSeed = 11;
  std::mt19937 random(kSeed);
  const auto lattice = [&] { return static_cast<int>(random() % 5) - 2; };
  const auto vector = [&] { return glm::dvec3(lattice(), lattice(), lattice()); };
  int lit = 0;
  for (int round = 0; round < 20000; ++round) {
    const glm::dvec3 u = vector(), v = vector(), n = vector();
    if (glm::length(glm::cross(u, v)) == 0 || glm::length(n) == 0) continue;
    scenes::AreaLight source = tests::rectangle_light(vector(), u, v);
    source.two_sided = round % 2 == 0;
    const Light light = light_of(source, {1});
    const glm::vec3 p(vector());
    const UnshadowedLight seen(light, p, glm::vec3(n));
    const double whole = seen.whole(), parts = seen.box({-1, -1}, {0, 0}) + seen.box({0, -1}, {1, 0}) +
                                               seen.box({-1, 0}, {0, 1}) + seen.box({0, 0}, {1, 1});
    ASSERT_GE(whole, 0) << "seed " << kSeed << ", round " << round;
    ASSERT_LE(whole, 1 + 16 * kUlp) << "seed " << kSeed << ", round " << round;
    ASSERT_NEAR(whole, parts, 32 * kUlp) << "seed " << kSeed << ", round " << round;
    lit += whole > 0.01 ? 1 : 0;
  }
  EXPECT_GT(lit, 2000);
}

TEST(UnshadowedLight, ASphereIsItsSolidAngle) {
  const Light light = light_of(shape("sphere"), {1});
  const glm::vec3 p(0.5f, 0, 0.25f);
  const double squared = 0.25 + 4 + 0.0625;
  EXPECT_NEAR(UnshadowedLight(light, p, glm::vec3(light.center) - p).whole(), 0.64 / squared, 1e-15);
  EXPECT_EQ(UnshadowedLight(light, light.center, {0, 1, 0}).whole(), 0);
}

}  // namespace
}  // namespace penumbra::compare
