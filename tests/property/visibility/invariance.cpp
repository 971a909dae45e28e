// SPDX-License-Identifier: Apache-2.0
// Tests changes that must not matter: the order of triangles, their winding and first vertex, doubled vertices; and
// scaling by a power of two, which must change nothing but the unit.

#include "tests/unit/mesh/shuffled.hpp"
#include "tests/unit/visibility/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace penumbra::visibility {
namespace {

/// A random soup over a floor, with pairs of triangles that share edges, doubled triangles and triangles seen edge-on.
scenes::Scene random_scene(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> real(-1.5, 1.5);
  std::uniform_int_distribution<int> lattice(-2, 2);
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, -2, 0}, {4, 0, 0}, {0, 0, -4}));
  std::vector<tests::Corners> soup;
  for (int i = 0; i < 12; ++i) {
    const glm::dvec3 a(real(random), real(random), real(random)), b(real(random), real(random), real(random)),
        c(real(random), real(random), real(random)), d(lattice(random), lattice(random), lattice(random)),
        e(lattice(random), lattice(random), lattice(random));
    soup.insert(soup.end(), {{a, b, c}, {b, a, d}, {a, d, e}, {d, e, c}});
    if (i % 4 == 0) soup.push_back({b, c, a});
  }
  tests::add_object(scene, "soup", soup);
  scene.lights.push_back(tests::ceiling_light(5, 1));
  scene.cameras.push_back(tests::camera({lattice(random) * 0.5, 2, 7}, {0, 0, 0}));
  return scene;
}

class Invariance : public testing::TestWithParam<std::uint32_t> {};

TEST_P(Invariance, OrderAndWindingOfTriangles) {
  const scenes::Scene scene = random_scene(GetParam());
  const tests::Stage plain(scene, 40, 40);
  scenes::Scene shuffled = scene;
  std::mt19937 random(GetParam() + 77);
  tests::shuffle_order(shuffled.soup, random);
  tests::shuffle_corners(shuffled.soup, random);
  const tests::Stage other(shuffled, 40, 40);
  EXPECT_EQ(plain.samples.p, other.samples.p);
  EXPECT_EQ(plain.samples.n, other.samples.n);
  EXPECT_EQ(plain.samples.depth, other.samples.depth);
  EXPECT_EQ(plain.samples.facing, other.samples.facing);
  for (std::size_t pixel = 0; pixel < plain.samples.size(); ++pixel) {
    const std::int32_t mine = plain.samples.triangle[pixel], theirs = other.samples.triangle[pixel];
    ASSERT_EQ(mine < 0, theirs < 0);
    if (mine < 0) continue;
    ASSERT_EQ(plain.floats.corners(static_cast<std::uint32_t>(mine)),
              other.floats.corners(static_cast<std::uint32_t>(theirs)));
  }
}

TEST_P(Invariance, ScaleByAPowerOfTwo) {
  const scenes::Scene scene = random_scene(GetParam());
  const tests::Stage plain(scene, 40, 40);
  const auto classes = classify_pixels(plain.floats, plain.samples, plain.light);
  for (const double scale : {0x1p-10, 0x1p10}) {
    scenes::Scene scaled = scene;
    for (glm::dvec3& position : scaled.soup.positions) position *= scale;
    auto& light = std::get<scenes::Rectangle>(scaled.lights[0].shape);
    light = {scale * light.center, scale * light.half_u, scale * light.half_v};
    scaled.cameras[0].eye *= scale;
    scaled.cameras[0].target *= scale;
    const tests::Stage other(scaled, 40, 40);
    const auto scale_all = [&](std::vector<glm::vec3> points) {
      for (glm::vec3& point : points) point *= static_cast<float>(scale);
      return points;
    };
    EXPECT_EQ(other.samples.triangle, plain.samples.triangle);
    EXPECT_EQ(other.samples.facing, plain.samples.facing);
    EXPECT_EQ(other.samples.n, plain.samples.n);
    EXPECT_EQ(other.samples.p, scale_all(plain.samples.p));
    EXPECT_EQ(other.light.points, scale_all(plain.light.points));
    EXPECT_EQ(other.floats.plane, plain.floats.plane);
    EXPECT_EQ(ranks(other.floats), ranks(plain.floats));
    EXPECT_EQ(classify_pixels(other.floats, other.samples, other.light), classes);
  }
}

TEST_P(Invariance, NoCracksBetweenNeighbours) {
  // A fan that fills the picture: every ray must be covered, whatever edge or vertex it passes through.
  std::mt19937 random(GetParam());
  std::uniform_int_distribution<int> lattice(-3, 3);
  const glm::dvec3 middle(lattice(random) / 8.0, lattice(random) / 8.0, lattice(random) / 8.0);
  scenes::Scene scene;
  std::vector<tests::Corners> fan;
  const std::array<glm::dvec3, 4> ring = {glm::dvec3(-4, -4, 0), glm::dvec3(4, -4, 0), glm::dvec3(4, 4, 0),
                                          glm::dvec3(-4, 4, 0)};
  for (std::size_t i = 0; i < 4; ++i) fan.push_back({middle, ring[i], ring[(i + 1) % 4]});
  tests::add_object(scene, "fan", fan);
  scene.lights.push_back(tests::ceiling_light(5, 1));
  scene.cameras.push_back(tests::camera({0, 0, 4}, {0, 0, 0}));
  const tests::Stage setup(scene, 33, 33);  // odd sizes: pixel centres lie on the diagonals
  EXPECT_EQ(std::count(setup.samples.triangle.begin(), setup.samples.triangle.end(), ViewSamples::kBackground), 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Invariance, testing::Range(0u, 10u));

}  // namespace
}  // namespace penumbra::visibility
