// SPDX-License-Identifier: Apache-2.0
#include "import/gltf/emitters/flat_light.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace penumbra::scenes {
namespace {

using Points = std::vector<glm::dvec3>;
using Triangles = std::vector<mesh::Triangle>;

// A 4 × 2 rectangle in the plane y = 3 whose front is below it: counter-clockwise seen from −y.
const Points kQuad{{-1, 3, -1}, {3, 3, -1}, {3, 3, 1}, {-1, 3, 1}};
constexpr double kFlatRounding = 1e-6;

import::FlatLight recognise(const Points& points, const Triangles& triangles){
    return recognise_flat_light(import::weld(points, triangles), kFlatRounding);
}  // namespace

void expect_quad(const import::FlatLight& light, double side) {
  const auto* rectangle = std::get_if<Rectangle>(&light);
  ASSERT_NE(rectangle, nullptr) << (std::holds_alternative<std::string>(light) ? std::get<std::string>(light)
                                                                               : "a polygon");
  EXPECT_EQ(rectangle->center, glm::dvec3(1, 3, 0));
  EXPECT_NEAR(glm::length(glm::cross(rectangle->half_u, rectangle->half_v)), 2, 1e-12);
  EXPECT_NEAR(std::max(glm::length(rectangle->half_u), glm::length(rectangle->half_v)), 2, 1e-12);
  EXPECT_EQ(glm::normalize(glm::cross(rectangle->half_u, rectangle->half_v)), glm::dvec3(0, side, 0));
}

TEST(FlatLight, AQuadIsARectangleInEveryOrderOfItsTriangles) {
  // Both diagonals, both orders of the triangles, each starting at each corner, and both windings.
  for (const auto& pair : {std::pair<mesh::Triangle, mesh::Triangle>{{0, 1, 2}, {0, 2, 3}}, {{0, 1, 3}, {1, 2, 3}}}) {
    for (int turn = 0; turn < 9; ++turn) {
      mesh::Triangle a = pair.first, b = pair.second;
      std::rotate(a.begin(), a.begin() + turn % 3, a.end());
      std::rotate(b.begin(), b.begin() + turn / 3, b.end());
      expect_quad(recognise(kQuad, {a, b}), -1);
      expect_quad(recognise(kQuad, {b, a}), -1);
      std::swap(a[0], a[1]);
      std::swap(b[0], b[1]);
      expect_quad(recognise(kQuad, {a, b}), 1);
    }
  }
}

TEST(FlatLight, SplitVerticesAndSubdivisionChangeNothing) {
  Points split = kQuad;
  split.insert(split.end(), kQuad.begin(), kQuad.end());  // each triangle has its own corners
  expect_quad(recognise(split, {{0, 1, 2}, {4, 6, 7}}), -1);
  Points grid;
  Triangles triangles;
  for (int z = 0; z <= 3; ++z) {
    for (int x = 0; x <= 5; ++x) grid.emplace_back(-1 + x * 0.8, 3, -1 + z * 2 / 3.0);
  }
  for (std::uint32_t z = 0; z < 3; ++z) {
    for (std::uint32_t x = 0; x < 5; ++x) {
      const std::uint32_t i = z * 6 + x;
      triangles.push_back({i, i + 1, i + 7});
      triangles.push_back({i, i + 7, i + 6});
    }
  }
  const import::FlatLight light = recognise(grid, triangles);
  ASSERT_TRUE(std::holds_alternative<Rectangle>(light));
  EXPECT_NEAR(glm::length(glm::cross(std::get<Rectangle>(light).half_u, std::get<Rectangle>(light).half_v)), 2, 1e-9);
  triangles.push_back({0, 0, 5});  // a triangle without area, which does no harm
  EXPECT_TRUE(std::holds_alternative<Rectangle>(recognise(grid, triangles)));
}

TEST(FlatLight, OtherConvexOutlinesArePolygons) {
  const import::FlatLight triangle = recognise(kQuad, {{0, 1, 2}});
  ASSERT_TRUE(std::holds_alternative<Polygon>(triangle));
  EXPECT_EQ(std::get<Polygon>(triangle).vertices, (Points{kQuad[0], kQuad[1], kQuad[2]}));
  const import::FlatLight leaning = recognise({{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  ASSERT_TRUE(std::holds_alternative<Polygon>(leaning));  // a parallelogram without right angles
  EXPECT_EQ(std::get<Polygon>(leaning).vertices.size(), 4u);
  Points disk{{0, 0, 0}};
  Triangles fan;
  for (std::uint32_t i = 0; i < 32; ++i) {
    disk.emplace_back(std::cos(i * M_PI / 16), std::sin(i * M_PI / 16), 0);
    fan.push_back({0, 1 + i, 1 + (i + 1) % 32});
  }
  const import::FlatLight round = recognise(disk, fan);
  ASSERT_TRUE(std::holds_alternative<Polygon>(round));
  EXPECT_EQ(std::get<Polygon>(round).vertices.size(), 32u);
}

TEST(FlatLight, OthersSayWhyNot) {
  const auto why_not = [](const Points& points, const Triangles& triangles) {
    const import::FlatLight light = recognise(points, triangles);
    return std::holds_alternative<std::string>(light) ? std::get<std::string>(light) : "it is a light";
  };
  const Points bent{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.01}, {0, 1, 0}};
  EXPECT_EQ(why_not(bent, {{0, 1, 2}, {0, 2, 3}}), "it is not flat");
  EXPECT_EQ(why_not(kQuad, {{0, 1, 1}}), "it has no area");
  EXPECT_EQ(why_not(kQuad, {{0, 1, 2}, {0, 2, 1}}), "it is closed or its triangles are wound both ways");
  const Points dart{{0, 0, 0}, {3, 0, 0}, {1, 1, 0}, {0, 3, 0}};
  EXPECT_EQ(why_not(dart, {{0, 1, 2}, {0, 2, 3}}), "its outline is not convex");
  const Points two{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}};
  EXPECT_EQ(why_not(two, {{0, 1, 2}, {3, 4, 5}}),
            "its triangles do not form one piece with a single outline and without holes");
  EXPECT_EQ(why_not(kQuad, {{0, 1, 2}, {1, 2, 0}}), "it is a light") << "a triangle that occurs twice counts once";
}

TEST(FlatLight, ToleratesTheRoundingAndNoMore) {
  Points tilted = kQuad;
  tilted[2].y += 0.9 * kFlatRounding;
  EXPECT_TRUE(std::holds_alternative<Rectangle>(recognise(tilted, {{0, 1, 2}, {0, 2, 3}})));
  tilted[2].y += 100 * kFlatRounding;
  EXPECT_TRUE(std::holds_alternative<std::string>(recognise(tilted, {{0, 1, 2}, {0, 2, 3}})));
  Points skewed = kQuad;
  skewed[2].x += 100 * kFlatRounding, skewed[3].x += 100 * kFlatRounding;
  EXPECT_TRUE(std::holds_alternative<Polygon>(recognise(skewed, {{0, 1, 2}, {0, 2, 3}})));
}

}  // namespace penumbra::scenes
}  // namespace penumbra::scenes
