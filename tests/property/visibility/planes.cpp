// SPDX-License-Identifier: Apache-2.0
// Tests plane ids, ranks and zero areas against their definitions on soups drawn from a tiny lattice, where coplanar,
// doubled and degenerate triangles are normal.

#include "tests/unit/visibility/scenes.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/plane_ids.hpp"
#include "visibility/scene_floats.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>

namespace penumbra::visibility {
namespace {

using Point = std::function<glm::dvec3()>;

SceneFloats soup(std::size_t triangles, const Point& point) {
  scenes::Scene scene;
  std::vector<tests::Corners> corners(triangles);
  for (tests::Corners& triangle : corners) triangle = {point(), point(), point()};
  tests::add_object(scene, "soup", corners);
  return make_scene_floats(scene);
}

/// Takes the corners as they are: no origin is subtracted, which would round them.
SceneFloats plain_soup(std::size_t triangles, const Point& point) {
  SceneFloats floats;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    for (int corner = 0; corner < 3; ++corner) floats.positions.emplace_back(point());
    floats.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  floats.plane = plane_ids(floats);
  return floats;
}

void expect_definition(const SceneFloats& floats) {
  const auto count = static_cast<std::uint32_t>(floats.triangles.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto a = floats.corners(i);
    const bool flat = collinear(a[0], a[1], a[2]);
    ASSERT_EQ(floats.plane[i] == SceneFloats::kNoPlane, flat);
    for (std::uint32_t j = 0; j < i && !flat; ++j) {
      if (floats.plane[j] == SceneFloats::kNoPlane) continue;
      ASSERT_EQ(floats.plane[i] == floats.plane[j], coplanar(a, floats.corners(j))) << i << ' ' << j;
    }
  }
}

class Planes : public testing::TestWithParam<std::uint32_t> {};

TEST_P(Planes, LatticeSoup) {
  std::mt19937 random(GetParam());
  std::uniform_int_distribution<int> lattice(-1, 1);
  expect_definition(soup(120, [&] { return glm::dvec3(lattice(random), lattice(random), lattice(random)); }));
}

TEST_P(Planes, LatticeOfUnevenSpacingAndWideExponents) {
  // Coordinates of very different magnitude on each axis, so that the last bits of some are next to the first bits of
  // others: values that do not fit 128-bit integers must still be decided.
  std::mt19937 random(GetParam() + 1000);
  const double values[] = {0, 1, -1, 0x1p-60, 0x1p40, 1 + 0x1p-23, -0x1p-60, 0x1p-100};
  std::uniform_int_distribution<std::size_t> pick(0, std::size(values) - 1);
  expect_definition(plain_soup(
      120, [&] { return glm::dvec3(values[pick(random)], values[pick(random) % 3], values[pick(random) % 5]); }));
}

TEST_P(Planes, NearlyCoplanar) {
  // A tilted plane with many triangles, some of whose corners are one ulp off it.
  std::mt19937 random(GetParam() + 2000);
  std::uniform_int_distribution<int> lattice(-8, 8), rarely(0, 11);
  expect_definition(plain_soup(120, [&] {
    const float x = static_cast<float>(lattice(random)) / 4, y = static_cast<float>(lattice(random)) / 4;
    float z = 2 * x - 3 * y;
    if (rarely(random) == 0) z = std::nextafter(z, 100.0f);
    return glm::dvec3(x, y, z);
  }));
}

TEST_P(Planes, PlanesWithoutAKeyModuloThePrime) {
  // Modulo the prime 2⁶¹ − 1, edges whose lengths are multiples of it (differences of floats reach them exactly) are 0.
  std::mt19937 random(GetParam() + 3000);
  const double values[] = {1, 0x1p61, 0x1p62};
  std::uniform_int_distribution<std::size_t> pick(0, 2);
  std::size_t large = 0;
  expect_definition(plain_soup(60, [&] {
    const glm::dvec3 q(values[pick(random)], values[pick(random) % 2], pick(random) == 0 ? 1.0 : 0.0);
    large += q.x > 1 && q.y > 1 ? 1 : 0;
    return q;
  }));
  EXPECT_GT(large, 10u);
}

TEST_P(Planes, RanksAreTheOrderOfTheSortedVertices) {
  std::mt19937 random(GetParam() + 4000);
  std::uniform_int_distribution<int> lattice(0, 1);
  const SceneFloats floats = soup(80, [&] { return glm::dvec3(lattice(random), lattice(random), lattice(random)); });
  const auto key = [&](std::uint32_t i) {
    std::array<float, 9> result{};
    const auto corners = floats.corners(i);
    for (std::size_t k = 0; k < 9; ++k) result[k] = corners[k / 3][static_cast<int>(k % 3)];
    return result;
  };
  const std::vector<std::uint32_t> rank = ranks(floats);
  for (std::uint32_t i = 0; i < 80; ++i) {
    for (std::uint32_t j = 0; j < 80; ++j) {
      ASSERT_EQ(rank[i] < rank[j], key(i) < key(j));
      ASSERT_EQ(rank[i] == rank[j], key(i) == key(j));
      ASSERT_EQ(floats.comes_before(i, j), key(i) < key(j));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Planes, testing::Range(0u, 12u));

}  // namespace
}  // namespace penumbra::visibility
