// SPDX-License-Identifier: Apache-2.0
// Exact areas against areas in closed form.
//
// Tolerance: the sweep adds at most a few hundred slabs of area ≤ 4 whose lengths are off by a few ulps of 1: 1e-12 is
// a thousand times that and far below what a wrong edge would cost.

#include "tests/unit/exact_area_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace penumbra::areas {
namespace {

using tests::area_scene;
using tests::AreaStage;
using tests::random_dyadic;

constexpr double kRounding = 1e-12;
constexpr double kLightHeight = 4;

struct Box2 {
  double x0, x1, z0, z1;
};

/// A horizontal rectangle at a height, as p sees it on the light's plane.
Box2 projected(const glm::dvec3& p, const Box2& box, double height) {
  const double scale = (kLightHeight - p.y) / (height - p.y);
  return {p.x + scale * (box.x0 - p.x), p.x + scale * (box.x1 - p.x), p.z + scale * (box.z0 - p.z),
          p.z + scale * (box.z1 - p.z)};
}

std::vector<tests::Corners> board(const Box2& box, double height) {
  return tests::quad({(box.x0 + box.x1) / 2, height, (box.z0 + box.z1) / 2}, {(box.x1 - box.x0) / 2, 0, 0},
                     {0, 0, (box.z1 - box.z0) / 2});
}

glm::vec3 random_floor_point(std::mt19937& random) {
  return {random_dyadic(random, -3, 3), 0, random_dyadic(random, -3, 3)};
}

TEST(ExactAreaClosedForm, AParallelRectangleHidesTheOverlapOfItsProjection) {
  std::mt19937 random(1);
  int part = 0;
  for (int scene_number = 0; scene_number < 20; ++scene_number) {
    const double x = random_dyadic(random, -1, 1), z = random_dyadic(random, -1, 1),
                 height = random_dyadic(random, 0.25, 3.75);
    const Box2 box{x, x + random_dyadic(random, 0.125, 1), z, z + random_dyadic(random, 0.125, 1)};
    scenes::Scene scene = area_scene(board(box, height));
    scene.lights.push_back(tests::ceiling_light(kLightHeight, 1));
    const AreaStage stage(scene);
    for (int i = 0; i < 50; ++i) {
      const glm::vec3 p = random_floor_point(random);
      const Box2 seen = projected(p, box, height);
      const double over_x = std::max(0.0, std::min(seen.x1, 1.0) - std::max(seen.x0, -1.0));
      const double over_z = std::max(0.0, std::min(seen.z1, 1.0) - std::max(seen.z0, -1.0));
      const double expected = 1 - over_x * over_z / 4;
      ASSERT_NEAR(stage.visibility(p), expected, kRounding);
      if (i == 0) {
        ASSERT_NEAR(stage.visibility(p, SweepArithmetic::rational), expected, kRounding);
      }
      part += expected > 0 && expected < 1 ? 1 : 0;
    }
  }
  EXPECT_GT(part, 100);
}

TEST(ExactAreaClosedForm, ManyDepthsCountOnceWhereTheyOverlap) {
  std::mt19937 random(2);
  for (int scene_number = 0; scene_number < 20; ++scene_number) {
    std::vector<std::pair<Box2, double>> boxes;
    std::vector<tests::Corners> triangles;
    for (int i = 0; i < 8; ++i) {
      const double x = random_dyadic(random, -1, 1), z = random_dyadic(random, -1, 1);
      boxes.push_back({{x, x + random_dyadic(random, 0.125, 0.5), z, z + random_dyadic(random, 0.125, 0.5)},
                       random_dyadic(random, 0.5, 3.5)});
      for (const tests::Corners& corners : board(boxes.back().first, boxes.back().second)) triangles.push_back(corners);
    }
    scenes::Scene scene = area_scene(triangles);
    scene.lights.push_back(tests::ceiling_light(kLightHeight, 1));
    const AreaStage stage(scene);
    for (int i = 0; i < 20; ++i) {
      const glm::vec3 p = random_floor_point(random);
      // The sides of all rectangles form a grid; each of its cells is wholly inside or outside each rectangle.
      std::set<double> xs = {-1, 1}, zs = {-1, 1};
      std::vector<Box2> seen;
      for (const auto& [box, height] : boxes) {
        seen.push_back(projected(p, box, height));
        for (const double x : {seen.back().x0, seen.back().x1}) xs.insert(std::clamp(x, -1.0, 1.0));
        for (const double z : {seen.back().z0, seen.back().z1}) zs.insert(std::clamp(z, -1.0, 1.0));
      }
      double hidden = 0;
      for (auto x = xs.begin(); std::next(x) != xs.end(); ++x) {
        for (auto z = zs.begin(); std::next(z) != zs.end(); ++z) {
          const double mid_x = (*x + *std::next(x)) / 2, mid_z = (*z + *std::next(z)) / 2;
          const bool in_some = std::ranges::any_of(seen, [&](const Box2& box) {
            return box.x0 < mid_x && mid_x < box.x1 && box.z0 < mid_z && mid_z < box.z1;
          });
          if (in_some) hidden += (*std::next(x) - *x) * (*std::next(z) - *z);
        }
      }
      ASSERT_NEAR(stage.visibility(p), 1 - hidden / 4, kRounding);
    }
  }
}

TEST(ExactAreaClosedForm, AHalfPlaneInAnyDirectionHidesItsSideOfTheLight) {
  std::mt19937 random(3);
  for (int i = 0; i < 100; ++i) {
    // The edge a x + b z = c at height 2 is seen as a x + b z = 2 c from p = 0.
    const double a = random_dyadic(random, -1, 1), b = random_dyadic(random, -1, 1),
                 c = random_dyadic(random, -0.5, 0.5);
    if (a * a + b * b < 0.25) continue;  // the triangle is not large enough for an edge that far away
    const glm::dvec3 along(-b, 0, a), into(a, 0, b);
    const glm::dvec3 on_edge = c / (a * a + b * b) * into + glm::dvec3(0, 2, 0);
    // One triangle whose long side is the edge; the side's ends, 16 away, are rounded to float, by 1e-6 at most.
    const glm::dvec3 unit = along / std::hypot(a, b), inward = into / std::hypot(a, b);
    scenes::Scene scene = area_scene({{on_edge - 16.0 * unit, on_edge + 16.0 * unit, on_edge + 16.0 * inward}});
    scene.lights.push_back(tests::ceiling_light(kLightHeight, 1));
    const AreaStage stage(scene);
    // The part of the square on the edge's visible side.
    std::vector<glm::dvec2> square = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, left;
    const auto height = [&](const glm::dvec2& q) { return 2 * c - a * q.x - b * q.y; };
    for (std::size_t k = 0; k < 4; ++k) {
      const glm::dvec2 q = square[k], r = square[(k + 1) % 4];
      if (height(q) >= 0) left.push_back(q);
      if ((height(q) >= 0) != (height(r) >= 0)) left.push_back(q + height(q) / (height(q) - height(r)) * (r - q));
    }
    double doubled = 0;
    for (std::size_t k = 0; k < left.size(); ++k) {
      const glm::dvec2 &q = left[k], &r = left[(k + 1) % left.size()];
      doubled += q.x * r.y - q.y * r.x;
    }
    // The edge is seen twice as large, so it is off by up to 4e-6, along at most 2√2: an area of 1.2e-5 out of 4.
    EXPECT_NEAR(stage.visibility({0, 0, 0}), doubled / 8, 3e-6) << a << " " << b << " " << c;
  }
}

TEST(ExactAreaClosedForm, TheHorizonHidesWhatIsBelowIt) {
  // The light stands upright at x = 4, from y = −1 to 1; the floor's horizon at 0 leaves its upper half. With the light
  // moved up by h the share above the horizon is (1 + h) / 2, and a board across z ≥ 0 hides half of that.
  for (const double h : {-0.75, -0.25, 0.0, 0.5}) {
    for (const bool hidden : {false, true}) {
      std::vector<tests::Corners> boards;
      if (hidden) boards = tests::quad({2, 0, 4}, {0, 8, 0}, {0, 0, 4});
      scenes::Scene scene = area_scene(boards);
      scene.lights.push_back(tests::rectangle_light({4, h, 0}, {0, 0, 1}, {0, 1, 0}));
      const AreaStage stage(scene);
      EXPECT_NEAR(stage.visibility({0, 0, 0}), (1 + h) / 2 * (hidden ? 0.5 : 1), kRounding) << h;
    }
  }
}

TEST(ExactAreaClosedForm, ATwoSidedLightLooksTheSameFromBehind) {
  for (const double side : {1.0, -1.0}) {
    scenes::Scene scene = area_scene(board({-0.25, 0.5, -0.125, 0.25}, 2));
    scene.lights.push_back(tests::rectangle_light({0, kLightHeight, 0}, {1, 0, 0}, {0, 0, side}));
    EXPECT_EQ(AreaStage(scene).visibility({0, 0, 0}), side > 0 ? 1 - 1.5 * 0.75 / 4 : 0.0);
    scene.lights[0].two_sided = true;
    EXPECT_NEAR(AreaStage(scene).visibility({0, 0, 0}), 1 - 1.5 * 0.75 / 4, kRounding);
  }
}

TEST(ExactAreaClosedForm, PolygonLights) {
  // A triangle light with its right angle at 0. A board over x ≥ 0.25 at half height hides its part x ≥ 0.5 from p = 0.
  scenes::Scene scene = area_scene(tests::quad({8.25, 2, 0}, {8, 0, 0}, {0, 0, 16}));
  scene.lights.emplace_back().shape = scenes::Polygon{{{0, 4, 0}, {1, 4, 0}, {0, 4, 1}}};
  EXPECT_NEAR(AreaStage(scene).visibility({0, 0, 0}), 0.75, kRounding);
  scene.lights[0].shape = scenes::Polygon{{{-1, 4, -1}, {1, 4, -1}, {2, 4, 0}, {1, 4, 1}, {-1, 4, 1}}};
  EXPECT_NEAR(AreaStage(scene).visibility({0, 0, 0}), 3.0 / 5, kRounding);
}

/// Returns the share of a disk of radius 1 that a board between it and p = 0, at half its height, leaves visible.
double disk_behind(const Box2& box) {
  scenes::Scene scene = area_scene(board(box, 2));
  scene.lights.emplace_back().shape = scenes::Disk{{0, 4, 0}, {0, -1, 0}, 1};
  return AreaStage(scene).visibility({0, 0, 0});
}

/// The part of a disk beyond a line at the distance c from its centre.
double segment_share(double c) {
  return (std::acos(c) - c * std::sqrt(1 - c * c)) / std::numbers::pi;
}

TEST(ExactAreaClosedForm, DiskAndSphereLightsLoseACircularSegment) {
  // A board over x ≥ c at half height hides, from p = 0, x ≥ 2 c of a disk of radius 1. The edge passes through the
  // centre, along a tangent (all or nothing), or one lattice step beside these. p sees a sphere as the disk of its
  // tangents; this sphere's disk has radius 1 at height 4, as the light's disk has: d − r²/d = 4, r √(1 − r²/d²) = 1.
  for (const double c : {-0.5, -0.484375, -0.375, 0.0, 0.125, 0.25, 0.484375, 0.5}) {
    const double visible = 1 - segment_share(2 * c);
    EXPECT_NEAR(disk_behind({c, 16 + c, -16, 16}), visible, kRounding) << c;
    EXPECT_NEAR(disk_behind({-16, 16, c, 16 + c}), visible, kRounding) << c;
    scenes::Scene scene = area_scene(board({c, 16 + c, -16, 16}, 2));
    scene.lights.emplace_back().shape = scenes::Sphere{{0, 4.25, 0}, std::sqrt(1.0625)};
    EXPECT_NEAR(AreaStage(scene).visibility({0, 0, 0}), visible, kRounding) << c;
  }
  EXPECT_EQ(disk_behind({0.5, 16, -16, 16}), 1.0) << "it touches the rim";
}

TEST(ExactAreaClosedForm, BoardsInsideAndAcrossADisk) {
  using std::numbers::pi;
  // Boards inside the disk, with corners on the rim where floats allow it (¾ and √7/4 do not: those are a step inside),
  // boards across the rim, and boards around the disk.
  EXPECT_NEAR(disk_behind({-0.25, 0.25, -0.25, 0.25}), 1 - 1 / pi, kRounding);
  EXPECT_NEAR(disk_behind({-0.25, 0.125, -0.375, 0.0625}), 1 - 0.75 * 0.875 / pi, kRounding);
  for (const double a : {0.75, 0.875, 0.984375})  // a square of half side a: four segments are left
    EXPECT_NEAR(disk_behind({-a / 2, a / 2, -a / 2, a / 2}), 4 * segment_share(a), kRounding) << a;
  EXPECT_EQ(disk_behind({-0.5, 0.5, -0.5, 0.5}), 0.0) << "four tangents";
  EXPECT_NEAR(disk_behind({0, 16, 0, 16}), 0.75, kRounding) << "a corner at the centre";
  EXPECT_NEAR(disk_behind({0, 0.5, -16, 16}), 0.5, kRounding) << "from the centre to a tangent";
  EXPECT_NEAR(disk_behind({0.25, 0.375, -16, 16}), 1 - segment_share(0.5) + segment_share(0.75), kRounding);
  // Corners on the rim with sides 3 : 4 : 5, as near as floats come: outside by 2.4e-8, which costs an area of the
  // order of its square.
  EXPECT_NEAR(disk_behind({-0.3F, 0.3F, -0.4F, 0.4F}), 1 - 4.0 * 0.6F * 0.8F / pi, kRounding);
}

TEST(ExactAreaClosedForm, TrianglesInADisk) {
  // Triangles that are inscribed as exactly as the lattice allows, and wedges that meet at the centre.
  const auto behind = [](const std::vector<tests::Corners>& triangles) {
    scenes::Scene scene = area_scene(triangles);
    scene.lights.emplace_back().shape = scenes::Disk{{0, 4, 0}, {0, -1, 0}, 1};
    return AreaStage(scene).visibility({0, 0, 0});
  };
  EXPECT_NEAR(behind({tests::Corners{glm::dvec3(-0.5, 2, 0), {0.5, 2, 0}, {0, 2, 0.5}}}), 1 - 1 / std::numbers::pi,
              kRounding)
      << "three corners on the rim";
  const tests::Corners eighth{glm::dvec3(0, 2, 0), {8, 2, 0}, {8, 2, 8}},
      next{glm::dvec3(0, 2, 0), {8, 2, 8}, {0, 2, 8}};
  EXPECT_NEAR(behind({eighth}), 7.0 / 8, kRounding);
  EXPECT_NEAR(behind({eighth, next}), 0.75, kRounding);
}

/// A disk's share beyond the horizon of a tilted receiver is a segment, too.
TEST(ExactAreaClosedForm, TheHorizonCutsADisk) {
  scenes::Scene scene = area_scene({});
  scene.lights.emplace_back().shape = scenes::Disk{{0, 0, 4}, {0, 0, -1}, 1};
  for (const double height : {-0.75, -0.5, 0.0, 0.25, 0.5}) {  // horizon at y = 0; the light stands upright
    std::get<scenes::Disk>(scene.lights[0].shape).center.y = height;
    EXPECT_NEAR(AreaStage(scene).visibility({0.25, 0, 0}), 1 - segment_share(height), kRounding) << height;
  }
}

TEST(ExactAreaClosedForm, NothingInTheWayIsExactlyOneAndEverythingExactlyZero) {
  for (const double size : {0.0, 16.0}) {
    scenes::Scene scene =
        area_scene(size == 0 ? std::vector<tests::Corners>{} : tests::quad({0, 2, 0}, {size, 0, 0}, {0, 0, size}));
    for (int kind = 0; kind < 4; ++kind) {
      scene.lights.assign(1, tests::ceiling_light(4, 1));
      if (kind == 1) scene.lights[0].shape = scenes::Disk{{0, 4, 0}, {0, -1, 0}, 1};
      if (kind == 2) scene.lights[0].shape = scenes::Polygon{{{0, 4, 0}, {1, 4, 0}, {0, 4, 1}}};
      if (kind == 3) scene.lights[0].shape = scenes::Sphere{{0, 4, 0}, 1};
      EXPECT_EQ(AreaStage(scene).visibility({0.5, 0, 0.25}), size == 0 ? 1.0 : 0.0) << kind;
    }
  }
}

}  // namespace
}  // namespace penumbra::areas
