// SPDX-License-Identifier: Apache-2.0
#include "import/polygon.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

namespace penumbra::mesh {
namespace {

/// Draws corners from a tiny lattice, so that collinear, repeated and crossing ones are normal.
std::vector<glm::dvec3> lattice_polygon() {
  const auto corner = rc::gen::apply([](int x, int y, int z) { return glm::dvec3(x, y, z); }, rc::gen::inRange(0, 4),
                                     rc::gen::inRange(0, 4), rc::gen::inRange(0, 2));
  const auto count = *rc::gen::inRange<std::size_t>(3, 12);
  return *rc::gen::container<std::vector<glm::dvec3>>(count, corner);
}

RC_GTEST_PROP(Polygon, AlwaysNMinusTwoTrianglesWithTheSameBoundary, ()) {
  const std::vector<glm::dvec3> corners = lattice_polygon();
  std::vector<Triangle> triangles;
  import::triangulate_polygon(corners, triangles);
  RC_ASSERT(triangles.size() == corners.size() - 2);
  // The vector area depends only on the boundary (Stokes), so it is the same for every triangulation; on the lattice it
  // is exact.
  glm::dvec3 whole(0), parts(0);
  for (std::size_t i = 0; i < corners.size(); ++i) whole += glm::cross(corners[i], corners[(i + 1) % corners.size()]);
  for (const auto& [a, b, c] : triangles) {
    RC_ASSERT(a < corners.size() && b < corners.size() && c < corners.size());
    parts += glm::cross(corners[b] - corners[a], corners[c] - corners[a]);
  }
  RC_ASSERT(whole == parts);
}

TEST(Polygon, EarsOfASimplePolygonAllLieInside) {
  // A comb of 2·n+2 corners, every second of them concave. No triangle may be wound the other way: then all lie inside.
  for (int teeth = 1; teeth < 20; ++teeth) {
    std::vector<glm::dvec3> corners{{0, 0, 3}, {teeth, 0, 3}};
    for (int i = teeth; i-- > 0;) {
      corners.emplace_back(i + 0.75, 2, 3);
      corners.emplace_back(i + 0.25, i > 0 ? 0.5 : 2, 3);
    }
    std::vector<Triangle> triangles;
    EXPECT_NE(import::triangulate_polygon(corners, triangles), import::PolygonKind::tangled) << teeth;
    for (const auto& [a, b, c] : triangles)
      EXPECT_GT(glm::cross(corners[b] - corners[a], corners[c] - corners[a]).z, 0);
  }
}

/// Corners in the middle of straight sides, exact or rounded to single precision: no triangle has zero area or is a
/// sliver, whichever corner comes first.
TEST(Polygon, StraightCornersMakeNoSlivers) {
  const std::vector<std::vector<glm::dvec3>> outlines = {
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}},  // a square
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {0, 3, 0}},  // a triangle with corners on one side
      {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 1, 0}},                        // a triangle given as a "quad"
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0.5, 0}}};  // an L
  for (const double angle : {0.0, 0.3, 1.1}) {
    for (std::vector<glm::dvec3> outline : outlines) {
      double area = 0;
      for (glm::dvec3& p : outline) {
        p = {p.x * std::cos(angle) - p.y * std::sin(angle), p.x * std::sin(angle) + p.y * std::cos(angle), p.z};
        if (angle > 1) p = glm::dvec3(glm::vec3(p));
      }
      for (std::size_t i = 0; i < outline.size(); ++i)
        area += glm::cross(outline[i], outline[(i + 1) % outline.size()]).z;
      for (std::size_t start = 0; start < outline.size(); ++start) {
        std::vector<Triangle> triangles;
        EXPECT_NE(import::triangulate_polygon(outline, triangles), import::PolygonKind::tangled);
        double sum = 0;
        for (const auto& [a, b, c] : triangles) {
          const double twice = glm::cross(outline[b] - outline[a], outline[c] - outline[a]).z;
          EXPECT_GT(twice, 0.2) << outline.size() << " corners turned by " << angle << ", from corner " << start;
          sum += twice;
        }
        EXPECT_NEAR(sum, area, 1e-6);
        std::rotate(outline.begin(), outline.begin() + 1, outline.end());
      }
    }
  }
}

/// Triangulation takes linear time for a square with a hundred thousand corners on one side.
TEST(Polygon, ManyStraightCorners) {
  std::vector<glm::dvec3> outline;
  for (int i = 0; i < 100'000; ++i) outline.emplace_back(i, 0, 0);
  outline.emplace_back(99'999, 5, 0);
  outline.emplace_back(0, 5, 0);
  std::vector<Triangle> triangles;
  EXPECT_EQ(import::triangulate_polygon(outline, triangles), import::PolygonKind::convex);
  ASSERT_EQ(triangles.size(), 100'000u);
  double sum = 0;
  for (const auto& [a, b, c] : triangles) {
    const double twice = glm::cross(outline[b] - outline[a], outline[c] - outline[a]).z;
    ASSERT_GT(twice, 0);
    sum += twice;
  }
  EXPECT_EQ(sum, 2 * 5 * 99'999.0);
}

/// The test of an ear looks only at corners near it: a star of twenty thousand corners, every second one concave.
TEST(Polygon, ManyConcaveCorners) {
  constexpr int kCorners = 20'000;
  std::vector<glm::dvec3> outline;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 6.283185307179586 * i / kCorners, radius = i % 2 == 0 ? 1 : 1.5;
    outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  std::vector<Triangle> triangles;
  EXPECT_EQ(import::triangulate_polygon(outline, triangles), import::PolygonKind::concave);
  ASSERT_EQ(triangles.size(), outline.size() - 2);
  for (const auto& [a, b, c] : triangles) {
    ASSERT_GT(glm::cross(outline[b] - outline[a], outline[c] - outline[a]).z, 0);
  }
}

TEST(Polygon, ACrossedOutlineIsSaidToBeTangled) {
  const std::vector<glm::dvec3> bow{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
  std::vector<Triangle> triangles;
  EXPECT_EQ(import::triangulate_polygon(bow, triangles), import::PolygonKind::convex)
      << "without area every corner is straight";
}

}  // namespace
}  // namespace penumbra::mesh
