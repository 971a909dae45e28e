// SPDX-License-Identifier: Apache-2.0
// Tests the sweep of rows=exact by itself: the area that no triangle covers does not depend on the direction of the
// rows.

#include "volumes/scatter/vectors/row_sweep.hpp"

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

namespace penumbra::volumes {
namespace {

constexpr double kSide = 8;

using Triangle = std::array<glm::dvec2, 3>;

double twice_area(const Triangle& t) {
  return (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x);
}

/// Returns triangles as layers: inside a triangle, of either winding, there is one layer more.
std::vector<RowEdge> outlines(std::span<const Triangle> triangles) {
  std::vector<RowEdge> edges;
  for (const Triangle& triangle : triangles) {
    const int wound = twice_area(triangle) > 0 ? 1 : -1;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec2 a = triangle[i], b = triangle[(i + 1) % 3];
      if (a.y < b.y) edges.push_back({a.x, a.y, b.x, b.y, wound});
      if (a.y > b.y) edges.push_back({b.x, b.y, a.x, a.y, -wound});
    }
  }
  return edges;
}

struct Measured {
  RowSweep::Area area;
  double of_parts = 0;
};
Measured measure(std::span<const Triangle> triangles) {
  std::vector<RowEdge> edges = outlines(triangles);
  std::vector<Trapezoid> parts;
  RowSweep sweep;
  Measured m{sweep({kSide, kSide, edges, {}, 0, &parts})};
  for (const auto& [low, high] : parts)
    m.of_parts += 0.5 * (low.right - low.left + high.right - high.left) * (high.y - low.y);
  return m;
}

std::vector<Triangle> quarter_turned(std::vector<Triangle> triangles) {
  for (Triangle& triangle : triangles)
    for (glm::dvec2& corner : triangle) corner = {kSide - corner.y, corner.x};
  return triangles;
}

/// On a lattice nearly everything coincides: corners with edges, edges with edges, three lines in one point. Off the
/// lattice, needles have every width.
TEST(RowSweep, TheDirectionOfRowsDoesNotMatter) {
  std::mt19937 random(1);
  double least = 1, most = 0;
  for (int round = 0; round < 4000; ++round) {
    const int steps = std::array{4, 8, 64, 1 << 20}[static_cast<std::size_t>(round % 4)];
    std::uniform_int_distribution<int> place(0, steps);
    const auto corner = [&] { return kSide / steps * glm::dvec2(place(random), place(random)); };
    std::vector<Triangle> triangles(1 + static_cast<std::size_t>(round) / 4 % 24);
    for (Triangle& triangle : triangles) {
      triangle = {corner(), corner(), corner()};
      if (round % 3 == 0) triangle[2] = 0.999999 * triangle[1] + 1e-6 * triangle[2];
    }
    const Measured first = measure(triangles);
    // Each end of a trapezoid is off by a few ulps of the side; a triangle has few ends, but all pairs of edges may
    // cross.
    const double tolerance = 1e-15 * kSide * kSide * static_cast<double>(triangles.size() * triangles.size() + 16);
    for (int turn = 0; turn < 4; ++turn) {
      const Measured turned = measure(triangles);
      EXPECT_NEAR(turned.area.visible, first.area.visible, tolerance) << round << " turned " << turn;
      EXPECT_NEAR(turned.of_parts, turned.area.visible, tolerance) << round << " turned " << turn;
      EXPECT_LT(std::abs(turned.area.impossible), tolerance) << round << " turned " << turn;
      triangles = quarter_turned(triangles);
    }
    least = std::min(least, first.area.visible / (kSide * kSide));
    most = std::max(most, first.area.visible / (kSide * kSide));
  }
  EXPECT_LT(least, 0.1);
  EXPECT_GT(most, 0.99);
}

/// Hierarchies list edges in any order: no digit of the result depends on it.
TEST(RowSweep, TheOrderOfEdgesDoesNotMatter) {
  std::mt19937 random(2);
  std::uniform_int_distribution<int> place(0, 6);
  for (int round = 0; round < 500; ++round) {
    const auto corner = [&] { return kSide / 6 * glm::dvec2(place(random), place(random)); };
    std::vector<Triangle> triangles(12);
    for (Triangle& triangle : triangles) triangle = {corner(), corner(), corner()};
    const Measured first = measure(triangles);
    for (int order = 0; order < 4; ++order) {
      std::ranges::shuffle(triangles, random);
      const Measured other = measure(triangles);
      EXPECT_EQ(other.area.visible, first.area.visible) << round;
      EXPECT_EQ(other.area.disorder, first.area.disorder) << round;
      EXPECT_EQ(other.of_parts, first.of_parts) << round;
    }
  }
}

/// Edges on one line, which after rounding differ only in their last digits: their computed crossings are anywhere,
/// also below the edges' beginnings. Each end of a gap is off by at most 24 · 2⁻⁵³ of the square (RowSweep); twelve
/// edges have up to 66 crossings and 24 ends, at each of which three gaps end, and both directions are measured:
/// 9.2e-11.
TEST(RowSweep, EdgesOnOneLine) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> share(0, 1);
  for (int round = 0; round < 200'000; ++round) {
    const auto place = [&] { return kSide * glm::dvec2(share(random), share(random)); };
    const glm::dvec2 from = place(), to = place();
    const auto on_line = [&] { return glm::mix(from, to, share(random)); };
    std::vector<Triangle> triangles(2 + static_cast<std::size_t>(round) % 3);
    for (Triangle& triangle : triangles) {
      triangle = {on_line(), on_line(), place()};
      if (round % 2 == 0) triangle[0] = from;
    }
    const Measured first = measure(triangles);
    const Measured turned = measure(quarter_turned(triangles));
    ASSERT_NEAR(turned.area.visible, first.area.visible, 1e-10) << round;
    ASSERT_NEAR(first.of_parts, first.area.visible, 1e-10) << round;
  }
}

/// Two of these lines seemed to cross far below their beginnings, by the quotient of two rounding errors: 73.08 in
/// place of 63.97.
TEST(RowSweep, LinesThatCrossedLongAgo) {
  std::vector<RowEdge> edges{
      {0x1.9bb14642ea861p+2, 0x1.c905bb0a32929p+2, 0x1.b76300bbcf031p+2, 0x1.e6e8a4ae8fd7cp+2, 1},
      {0x1.36855427c3a49p+1, 0x1.6895c90f1f05fp+1, 0x1.9bb14642ea861p+2, 0x1.c905bb0a32929p+2, 1},
      {0x1.36855427c3a49p+1, 0x1.6895c90f1f05fp+1, 0x1.b76300bbcf031p+2, 0x1.e6e8a4ae8fd7cp+2, -1},
      {0x1.f106766de17a8p+1, 0x1.18ed14f83b72cp+2, 0x1.021500c33bd11p+2, 0x1.2340c39fd16d3p+2, -1},
      {0x1p+1, 0x1p+1, 0x1.021500c33bd11p+2, 0x1.2340c39fd16d3p+2, 1},
      {0x1p+1, 0x1p+1, 0x1.f106766de17a8p+1, 0x1.18ed14f83b72cp+2, -1}};
  RowSweep sweep;
  const RowSweep::Area area = sweep({kSide, kSide, edges, {}, 0, nullptr});
  EXPECT_NEAR(area.visible, 63.9733, 1e-4);
  EXPECT_LT(area.disorder, 1e-11);
}

TEST(RowSweep, OneTriangleLeavesTheRest) {
  const Triangle triangle{glm::dvec2(1, 1), glm::dvec2(7, 2), glm::dvec2(3, 6)};
  const std::vector<Triangle> one{triangle};
  EXPECT_NEAR(measure(one).area.visible, kSide * kSide - 0.5 * twice_area(triangle), 1e-13);
  const std::array doubled{triangle, triangle};
  EXPECT_NEAR(measure(doubled).area.visible, kSide * kSide - 0.5 * twice_area(triangle), 1e-13);
}

/// The depth at the left side goes up and down again: one strip is dark.
TEST(RowSweep, StepsAtTheLeftSide) {
  std::vector<RowEdge> edges{{0, 2, 8, 2.5, 1}, {0, 4, 8, 5.5, -1}};
  std::vector<RowStep> steps{{4, -1}, {2, 1}};
  RowSweep sweep;
  const RowSweep::Area area = sweep({kSide, kSide, edges, steps, 0, nullptr});
  EXPECT_NEAR(area.visible, kSide * kSide - 0.5 * (2 + 3) * 8, 1e-13);
  EXPECT_NEAR(area.impossible, 0, 1e-13);
  EXPECT_LT(area.disorder, 16 * 0x1p-48 * kSide * kSide) << "only rounding may cause disorder";
}

}  // namespace
}  // namespace penumbra::volumes
