// SPDX-License-Identifier: Apache-2.0
// Tests silhouette maps: outlines between texels against closed forms, and what happens to two outlines in one texel.

#include "maps/products/silhouette_points.hpp"
#include "tests/analytic/maps/backprojection_scenes.hpp"

#include <cmath>
#include <random>

namespace penumbra::tests {
namespace {

using maps::SilhouetteEnd;
using maps::SilhouettePoint;

TEST(SilhouettePoints, AreEndsOrLieOnDiagonals) {
  constexpr std::uint32_t kCount = 4;
  std::vector<SilhouettePoint> cells(kCount * kCount);
  // The line y = 0.25 + x/2 from x = 0.2 to 3.5. Cell (0, 0) gets its end. In cell (1, 0), from (1, 0.75) to (1.5, 1),
  // it meets x + y = 1 where 1.5 x' + 0.75 = 1, x' = 1/6, and y = x where 0.75 − x'/2 = 0, which is beyond the cell. In
  // cell (1, 1), from (1.5, 1), it meets x + y = 1 where 0.5 + t + t/2 = 1, t = 1/3, and misses y = x.
  maps::add_silhouette({{0.2, 0.35}, 2}, {{3.5, 2.0}, 2}, kCount, cells);
  const auto at = [&](std::uint32_t x, std::uint32_t y) { return cells[y * kCount + x]; };
  EXPECT_NEAR(glm::length(at(0, 0).at - glm::dvec2(0.2, 0.35)), 0, 1e-12);
  EXPECT_NEAR(glm::length(at(1, 0).at - glm::dvec2(1.0 / 6, 0.75 + 1.0 / 12)), 0, 1e-12);
  EXPECT_NEAR(glm::length(at(1, 1).at - glm::dvec2(0.5 + 1.0 / 3, 1.0 / 6)), 0, 1e-12);
  EXPECT_EQ(at(3, 3).depth, 0);
  EXPECT_EQ(at(3, 3).at, glm::dvec2(0.5));
  // If a silhouette crosses both diagonals, its point is midway: x = 2.4 crosses them at 0.4 and 0.6.
  std::vector<SilhouettePoint> upright(kCount * kCount);
  maps::add_silhouette({{2.4, -3}, 1}, {{2.4, 9}, 3}, kCount, upright);
  for (std::uint32_t y = 0; y < kCount; ++y)
    EXPECT_NEAR(glm::length(upright[y * kCount + 2].at - glm::dvec2(0.4, 0.5)), 0, 1e-12);
  // 1/depth is linear along the edge: the point in cell y = 1 is at (3 + 1.5)/12 of its length.
  EXPECT_NEAR(upright[kCount + 2].depth, 1 / (1 - 4.5 / 12 * (1 - 1.0 / 3)), 1e-12);
}

/// The nearest edge in a cell counts, whatever the order of edges.
TEST(SilhouettePoints, DependOnNoOrder) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-1, 9), depth(1, 4);
  std::vector<std::pair<SilhouetteEnd, SilhouetteEnd>> edges;
  for (int i = 0; i < 60; ++i)
    edges.push_back({{{place(random), place(random)}, depth(random)}, {{place(random), place(random)}, depth(random)}});
  std::vector<SilhouettePoint> one(64), other(64);
  for (const auto& [a, b] : edges) maps::add_silhouette(a, b, 8, one);
  for (auto edge = edges.rbegin(); edge != edges.rend(); ++edge)
    maps::add_silhouette(edge->second, edge->first, 8, other);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].at, other[i].at) << i;
    EXPECT_EQ(one[i].depth, other[i].depth) << i;
  }
}

class SilhouetteMaps : public MapsTest {
 protected:
  static constexpr std::uint32_t kSide = 160;
  /// Counts pixels of the floor whose V is not the hard shadow of a board, which is given by its middle and half-sides;
  /// pixels within `beyond` of the shadows of its corners are skipped.
  struct Wrong {
    int pixels = 0, shaded = 0;
  };
  static Wrong wrong(const Masks& found, const Stage& stage, const glm::dvec3& middle, const glm::dvec3& u,
                     const glm::dvec3& v, double beyond) {
    Wrong count;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      const glm::dvec3 p = glm::dvec3(stage.samples.p[i]) + stage.floats.origin, light(0, 5, 0);
      const glm::dvec3 n = glm::cross(u, v);
      const double t = glm::dot(middle - p, n) / glm::dot(light - p, n);
      const glm::dvec3 on = p + t * (light - p) - middle;
      const double a = glm::dot(on, u) / glm::dot(u, u), b = glm::dot(on, v) / glm::dot(v, v);
      bool at_corner = false;
      for (const double x : {-1.0, 1.0}) {
        for (const double y : {-1.0, 1.0}) {
          const glm::dvec3 corner = middle + x * u + y * v;
          const glm::dvec3 shadow = light + (corner - light) * (5 / (5 - corner.y));
          at_corner = at_corner || glm::distance(shadow, p) < beyond;
        }
      }
      if (at_corner || std::abs(std::max(std::abs(a), std::abs(b)) - 1) < 1e-5) continue;
      const bool hidden = std::max(std::abs(a), std::abs(b)) < 1;
      count.shaded += hidden ? 1 : 0;
      count.pixels += (found.visibility[i] == 0) != hidden ? 1 : 0;
    }
    return count;
  }
};

/// A turned board, level or tilted, over a floor in a map of 64 texels, each 0.065 wide there: its outline is straight,
/// whereas a hard shadow's has steps. The texels around its corners are skipped.
TEST_F(SilhouetteMaps, OutlinesAreStraight) {
  for (const double rise : {0.0, 0.3}) {
    const glm::dvec3 middle(0.11, 2, 0.07), u(0.62, rise, 0.23), v(-0.2, 0.0, 0.539130434782608);
    scenes::Scene scene = bare_floor(0.3);
    add_quad(scene, middle, u, v).receives_shadow = false;
    const Stage stage = on_floor(scene, kSide, light_samples(1));
    const visibility::MethodOptions size{{"size", "64"}};
    const auto method = maps::make_silhouette_map(device(), size);
    const Masks found = run(*method, stage);
    const Wrong straight = wrong(found, stage, middle, u, v, 0.14);
    const Wrong steps = wrong(run(*maps::make_shadow_map(device(), size), stage), stage, middle, u, v, 0.14);
    EXPECT_EQ(straight.pixels, 0) << rise;
    EXPECT_GT(steps.pixels, 80) << rise;
    EXPECT_GT(straight.shaded, 2000) << rise;
    EXPECT_EQ(method->counters().at("silhouetteEdges"), 4U);
    EXPECT_GT(method->counters().at("silhouetteCells"), 40U);
    EXPECT_EQ(run(*method, stage, 7).visibility, found.visibility);
  }
}

/// Two outlines in one texel: a bar half a texel wide between texel centres is lost, as in the paper; one 2.6 texels
/// wide has both its sides.
TEST_F(SilhouetteMaps, ABarWithinATexelIsLost) {
  for (const bool wide : {false, true}) {
    constexpr double kTexel = 2 * 0.4 / 62;  // at distance 1
    // In a map of even size, texel centres are ± half a texel from the middle: the bar is between them.
    const glm::dvec3 middle(0, 2, 0), u((wide ? 1.3 : 0.25) * kTexel * 3, 0, 0), v(0, 0, 0.7);
    scenes::Scene scene = bare_floor(0.3);
    add_quad(scene, middle, u, v).receives_shadow = false;
    const Stage stage = on_floor(scene, kSide, light_samples(1));
    const Masks found = run(*maps::make_silhouette_map(device(), {{"size", "64"}}), stage);
    const Wrong lost = wrong(found, stage, middle, u, v, 0.14);
    EXPECT_GT(lost.shaded, 100);
    if (wide) {
      EXPECT_EQ(lost.pixels, 0);
    } else {
      EXPECT_EQ(lost.pixels, lost.shaded) << "all of it";
    }
  }
}

}  // namespace
}  // namespace penumbra::tests
