// SPDX-License-Identifier: Apache-2.0
// Compares sums over silhouettes, for textured lights and spheres, with the triangles one by one and with `exact`.

#include "tests/unit/coverage_stage.hpp"
#include "tests/unit/exact_area_soups.hpp"
#include "volumes/wedges/coverage_validation.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace penumbra::volumes {
namespace {

using tests::CoverageStage;
using tests::Lamp;

scenes::Texture random_texture(std::mt19937& random) {
  scenes::Texture texture;
  std::uniform_int_distribution<std::uint32_t> size(1, 6);
  texture.width = size(random);
  texture.height = size(random);
  for (std::uint32_t i = 0; i < texture.width * texture.height; ++i) {
    const float red = static_cast<float>(1 + random() % 8) / 4, blue = static_cast<float>(random() % 8) / 4;
    texture.texels.emplace_back(red, 0.5F, blue);
  }
  return texture;
}

/// Makes a soup between the floor and the light, neither of which any triangle touches.
std::vector<tests::Corners> soup_below(std::mt19937& random, int count) {
  std::vector<tests::Corners> soup = tests::lattice_soup(random, count);
  for (tests::Corners& corners : soup) {
    for (glm::dvec3& corner : corners) corner.y = corner.y * 0.5 - 0.25;  // −1 … 1.5
  }
  return soup;
}

struct Found {
  int part = 0, moved = 0;
  double most = 0;
};

/// Checks the sums as CoverageAgreement.TheReceiversSilhouettesAddUpToItsLayers does, each to within `tolerance`.
void expect_layers(const CoverageStage& stage, std::mt19937& random, double tolerance, Found& found) {
  const TextureWeights* texture = stage.soft.texture();
  for (int j = 0; j < 20; ++j) {
    const glm::vec3 p = tests::soup_receiver(random);
    const LayerSum sum = stage.receiver(p);
    const auto layers = stage.layers(p);
    const double expected = sum_of_layers(stage.soft.outline(), layers, texture), exact = 1 - stage.exact(p);
    const double overlap = overlap_of_layers(stage.soft.outline(), layers, 100, texture);
    ASSERT_NEAR(sum.blocked, expected, tolerance) << j;
    ASSERT_GE(expected - exact, -tolerance);
    ASSERT_LE(expected - exact, overlap + tolerance);
    found.part += expected > 0 && expected < 1 ? 1 : 0;
    found.moved += sum.moved ? 1 : 0;
    found.most = std::max(found.most, std::abs(sum.blocked - expected));
  }
}

TEST(CoverageLights, TexturedLayersAddUp) {
  std::mt19937 random(21);
  Found found;
  for (int i = 0; i < 60; ++i) {
    scenes::Scene scene = tests::soup_scene(soup_below(random, 2 + i % 7), i % 2 == 0 ? Lamp::flat : Lamp::tilted);
    scene.lights[0].texture = random_texture(random);
    const CoverageStage stage(scene);
    ASSERT_NE(stage.soft.texture(), nullptr);
    // Each edge takes three walks over texels, each triangle's polygon has at most seven sides; a walk is off by 2⁻²⁴ ·
    // brightest if it is nearly upright (property/volumes/coverage_textures.cpp). At most 16 triangles, so 48 edges.
    const double walks = 48 * 3 + 16 * 7;
    expect_layers(stage, random, walks * 0x1p-24 * stage.soft.texture()->brightest() + 1e-9, found);
    if (HasFatalFailure()) FAIL() << "scene " << i;
  }
  fmt::print("textured: {} partly hidden, {} moved, sums off by {:.1e} at most\n", found.part, found.moved, found.most);
  EXPECT_GT(found.part, 250);
  EXPECT_LT(found.most, 1e-9) << "upright walks are rare, so the sums are far better than their bound";
}

TEST(CoverageLights, SpheresAreDisksThatFaceTheReceiver) {
  std::mt19937 random(22);
  Found found;
  for (int i = 0; i < 60; ++i) {
    const CoverageStage stage(tests::soup_scene(soup_below(random, 2 + i % 7), Lamp::sphere));
    ASSERT_FALSE(stage.soft.something_touches_light());
    // `exact` replaces the disk by a polygon, off by 7.6e-8 at most.
    expect_layers(stage, random, 1e-7, found);
    if (HasFatalFailure()) FAIL() << "scene " << i;
  }
  fmt::print("spheres: {} partly hidden, {} moved, sums off by {:.1e} at most\n", found.part, found.moved, found.most);
  EXPECT_GT(found.part, 250);
  EXPECT_LT(found.most, 1e-9);
}

/// A vertex appears exactly at a sphere's centre, so areas are computed from another reference point of the facing
/// disk, which floats can only represent approximately.
TEST(CoverageLights, ASpheresReferencePointMoves) {
  const tests::Corners triangle{glm::dvec3(0.25, 0.75, 0), {1.25, 0.75, 0.25}, {0.5, 1, 1.25}};
  const CoverageStage stage(tests::soup_scene({triangle}, Lamp::sphere));
  const glm::vec3 p(0.25, -1, 0);
  const LayerSum sum = stage.receiver(p);
  EXPECT_TRUE(sum.moved);
  EXPECT_GT(sum.blocked, 0.05);
  EXPECT_NEAR(sum.blocked, sum_of_layers(stage.soft.outline(), stage.layers(p)), 1e-12);
  EXPECT_NEAR(sum.blocked, 1 - stage.exact(p), 1e-7);
}

/// Returns boards side by side, parallel to the floor: the centre sees the same silhouettes as the receiver, and V is
/// exact.
scenes::Scene boards_apart() {
  std::vector<tests::Corners> boards;
  for (int i = 0; i < 9; ++i) {
    const int column = i % 3, row = i / 3;
    const glm::dvec3 at((column - 1) * 2.5, 0.5 + i / 16.0, (row - 1) * 2.5);
    const glm::dvec3 a = at + glm::dvec3(-0.5, 0, -0.25), b = at + glm::dvec3(0.5, 0, -0.375),
                     c = at + glm::dvec3(0.25, 0, 0.5), d = at + glm::dvec3(-0.375, 0, 0.375);
    boards.push_back({a, b, c});
    boards.push_back({a, c, d});
  }
  return tests::area_scene(boards);
}

TEST(CoverageLights, PlanarCastersOfATexturedLightAndOfASphereAreExact) {
  std::mt19937 random(23);
  for (const bool sphere : {false, true}) {
    scenes::Scene scene = boards_apart();
    scene.lights.push_back(tests::rectangle_light({0.125, 4, 0}, {0.5, 0, 0.125}, {0.125, 0.25, 0.5}));
    if (sphere) scene.lights[0].shape = scenes::Sphere{{0.125, 4, 0}, 0.5};
    if (!sphere) scene.lights[0].texture = random_texture(random);
    const CoverageStage stage(scene);
    // Nine boards with five edges, three walks each; for a sphere, the error of the disk's polygon.
    const double tolerance = sphere ? 1e-7 : 9 * 5 * 3 * 0x1p-24 * stage.soft.texture()->brightest();
    double most = 0;
    int penumbra = 0;
    for (int i = 0; i < 1500; ++i) {
      const glm::vec3 p(tests::random_dyadic(random, -4, 4), 0, tests::random_dyadic(random, -4, 4));
      const double exact = stage.exact(p), found = stage.center(p).visibility;
      ASSERT_NEAR(found, exact, tolerance) << p.x << " " << p.z;
      most = std::max(most, std::abs(found - exact));
      penumbra += exact > 0.001 && exact < 0.999 ? 1 : 0;
    }
    fmt::print("{}: {} in penumbra, off by {:.1e} at most\n", sphere ? "sphere" : "texture", penumbra, most);
    EXPECT_GT(penumbra, 200);
  }
}

TEST(CoverageLights, ASphereIsTouchedByWhatReachesTheBall) {
  const auto touched = [](const tests::Corners& triangle) {
    return CoverageStage(tests::soup_scene({triangle}, Lamp::sphere)).soft.something_touches_light();
  };
  const glm::dvec3 c(0.25, 2.5, 0);  // radius 0.75
  EXPECT_TRUE(touched({c + glm::dvec3(-8, -0.75, -8), c + glm::dvec3(8, -0.75, -8), c + glm::dvec3(0, -0.75, 8)}));
  EXPECT_FALSE(
      touched({c + glm::dvec3(-8, -0.765625, -8), c + glm::dvec3(8, -0.765625, -8), c + glm::dvec3(0, -0.765625, 8)}));
  EXPECT_TRUE(touched({c + glm::dvec3(0.5, 0.5, 0), c + glm::dvec3(4, 0, 0), c + glm::dvec3(4, 1, 0)}));
  EXPECT_FALSE(touched({c + glm::dvec3(0.625, 0.625, 0), c + glm::dvec3(4, 0.625, 0), c + glm::dvec3(4, 1, 0)}));
  EXPECT_TRUE(touched({c, c + glm::dvec3(0.25, 0, 0), c + glm::dvec3(0, 0.25, 0)})) << "within it";
}

/// A wrong sum is noticed: the silhouettes of a scene that lacks one board are compared with all triangles.
TEST(CoverageLights, TheInvariantIsCheckedOfThem) {
  std::mt19937 random(24);
  for (const bool sphere : {false, true}) {
    scenes::Scene scene = tests::soup_scene(soup_below(random, 6), sphere ? Lamp::sphere : Lamp::tilted);
    if (!sphere) scene.lights[0].texture = random_texture(random);
    const CoverageStage stage(scene);
    std::vector<LitPoint> samples;
    for (int i = 0; i < 50; ++i) samples.push_back(stage.lit(tests::soup_receiver(random)));
    ValidationReport report;
    const auto points = check_coverage(stage.soft, stage.light, samples, report);
    EXPECT_TRUE(report.violations.empty());
    EXPECT_EQ(report.checks[static_cast<std::size_t>(Invariant::coverage)], points.size());
    std::size_t partly = 0;
    for (const CoveragePoint& point : points) {
      partly += point.receiver > 0.01 ? 1 : 0;
      const double hidden = 1 - stage.area.visibility({point.sample.p, point.sample.carrier, point.sample.facing});
      check_union(point, hidden, sphere ? 1e-7 : 0, report);
      EXPECT_TRUE(report.violations.empty());
    }
    EXPECT_GT(partly, 10U);
    check_union(points.front(), points.front().receiver + 2 * points.front().tolerance + 1e-7, 0, report);
    EXPECT_EQ(report.violations.size(), 1U);
  }
}

}  // namespace
}  // namespace penumbra::volumes
