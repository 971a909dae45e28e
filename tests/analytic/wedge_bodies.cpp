// SPDX-License-Identifier: Apache-2.0
// Tests wedges as meshes for viewing, and their sections by a plane, against closed forms.
#include "volumes/wedges/wedge_body.hpp"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace penumbra::volumes {
namespace {

const Box kCube{{0, 0, 0}, {2, 2, 2}};

WedgeBody body_of(std::vector<Plane> planes) {
  Wedge wedge;
  wedge.planes = std::move(planes);
  return wedge_body(wedge, kCube);
}

double volume_of(const WedgeBody& body) {
  double sum = 0;
  for (const auto& [a, b, c] : body.triangles)
    sum += glm::dot(body.corners[a], glm::cross(body.corners[b], body.corners[c])) / 6;
  return sum;
}

/// Returns the area of a section whose corners run counter-clockwise as seen from +y.
double area_of_section(const std::vector<glm::dvec3>& corners) {
  double doubled = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    doubled += a.z * b.x - a.x * b.z;
  }
  return doubled / 2;
}

TEST(WedgeBodies, HaveTheVolumeOfWhatTheyShareWithTheBox) {
  EXPECT_DOUBLE_EQ(volume_of(body_of({})), 8);
  const WedgeBody prism = body_of({{1, -1, 0, 0}});  // x ≥ y
  EXPECT_DOUBLE_EQ(volume_of(prism), 4);
  EXPECT_EQ(prism.corners.size(), 6U);
  EXPECT_EQ(prism.edges.size(), 9U);
  const WedgeBody corner = body_of({{-1, -1, -1, 1}});  // x + y + z ≤ 1
  EXPECT_DOUBLE_EQ(volume_of(corner), 1.0 / 6);
  EXPECT_EQ(corner.edges.size(), 6U);
}

TEST(WedgeBodies, AreNoneWhereThereIsNoVolume) {
  EXPECT_TRUE(body_of({{1, 0, 0, -3}}).corners.empty());    // beside the box
  EXPECT_TRUE(body_of({{-1, 0, 0, 0}}).triangles.empty());  // touches a face
  EXPECT_TRUE(body_of({{NAN, 0, 0, 0}}).corners.empty());
  Wedge everywhere;
  everywhere.outcome = WedgeOutcome::everywhere;
  EXPECT_TRUE(wedge_body(everywhere, kCube).corners.empty());
}

TEST(WedgeBodies, AreCutByHorizontalPlanes) {
  const WedgeBody prism = body_of({{1, -1, 0, 0}});  // x ≥ y: at height y a rectangle of 2 − y by 2
  for (const double height : {0.0, 0.25, 1.0, 1.75}) {
    const std::vector<glm::dvec3> section = section_at(prism, height);
    EXPECT_EQ(section.size(), 4U) << height;
    EXPECT_DOUBLE_EQ(area_of_section(section), (2 - height) * 2);
    for (const glm::dvec3& corner : section) EXPECT_EQ(corner.y, height);
  }
  EXPECT_TRUE(section_at(prism, 2).empty());  // an edge
  EXPECT_TRUE(section_at(prism, -0.5).empty());
  EXPECT_TRUE(section_at(WedgeBody{}, 0).empty());
  const WedgeBody corner = body_of({{-1, -1, -1, 1}});
  EXPECT_NEAR(area_of_section(section_at(corner, 0.5)), 0.125, 1e-15);
}

TEST(WedgeBodies, HullsOfLightsAreClosed) {
  LightHull hull;
  hull.is_solid = true;
  for (int i = 0; i < 6; ++i)
    hull.corners.push_back((i < 3 ? 1.0 : -1.0) * glm::dvec3(i % 3 == 0, i % 3 == 1, i % 3 == 2));
  EXPECT_DOUBLE_EQ(volume_of({hull.corners, hull_triangles(hull), {}}), 4.0 / 3);  // an octahedron
  hull.is_solid = false;
  EXPECT_EQ(hull_triangles(hull).size(), 4U);
}

}  // namespace
}  // namespace penumbra::volumes
