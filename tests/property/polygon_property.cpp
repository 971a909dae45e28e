#include "import/polygon.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

namespace penumbra::mesh {
namespace {

/// Corners on a tiny lattice, so that collinear, repeated and crossing ones are normal.
std::vector<glm::dvec3> lattice_polygon() {
  const auto corner = rc::gen::apply([](int x, int y, int z) { return glm::dvec3(x, y, z); }, rc::gen::inRange(0, 4),
                                     rc::gen::inRange(0, 4), rc::gen::inRange(0, 2));
  const auto count = *rc::gen::inRange<std::size_t>(3, 12);
  return *rc::gen::container<std::vector<glm::dvec3>>(count, corner);
}

RC_GTEST_PROP(Polygon, AlwaysNMinusTwoTrianglesWithTheSameBoundary, ()) {
  const std::vector<glm::dvec3> corners = lattice_polygon();
  std::vector<Triangle> triangles;
  triangulate_polygon(corners, triangles);
  RC_ASSERT(triangles.size() == corners.size() - 2);
  // The vector area is an integral over the boundary alone (Stokes), so every triangulation has the same; on the
  // lattice it is exact.
  glm::dvec3 whole(0), parts(0);
  for (std::size_t i = 0; i < corners.size(); ++i) whole += glm::cross(corners[i], corners[(i + 1) % corners.size()]);
  for (const auto& [a, b, c] : triangles) {
    RC_ASSERT(a < corners.size() && b < corners.size() && c < corners.size());
    parts += glm::cross(corners[b] - corners[a], corners[c] - corners[a]);
  }
  RC_ASSERT(whole == parts);
}

TEST(Polygon, EarsOfASimplePolygonAllLieInside) {
  // A comb: 2·n+2 corners, concave at every second one. Inside means that no triangle turns the other way.
  for (int teeth = 1; teeth < 20; ++teeth) {
    std::vector<glm::dvec3> corners{{0, 0, 3}, {teeth, 0, 3}};
    for (int i = teeth; i-- > 0;) {
      corners.emplace_back(i + 0.75, 2, 3);
      corners.emplace_back(i + 0.25, i > 0 ? 0.5 : 2, 3);
    }
    std::vector<Triangle> triangles;
    EXPECT_NE(triangulate_polygon(corners, triangles), PolygonKind::tangled) << teeth;
    for (const auto& [a, b, c] : triangles)
      EXPECT_GT(glm::cross(corners[b] - corners[a], corners[c] - corners[a]).z, 0);
  }
}

TEST(Polygon, ACrossedOutlineIsSaidToBeTangled) {
  const std::vector<glm::dvec3> bow{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
  std::vector<Triangle> triangles;
  EXPECT_EQ(triangulate_polygon(bow, triangles), PolygonKind::convex) << "without area every corner is straight";
}

}  // namespace
}  // namespace penumbra::mesh
