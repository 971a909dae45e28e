// SPDX-License-Identifier: Apache-2.0
// Tests diagnoses of meshes small enough to count their defects by hand: edges, vertices, windings, components.

#include "mesh/diagnosis/diagnosis.hpp"

#include "tests/unit/mesh/diagnosis_soups.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace penumbra::mesh {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Diagnosis, Nothing) {
  const Diagnosis d = diagnosis_of({});
  EXPECT_EQ(d.triangles + d.vertices + d.components + all_defects(d), 0);
  EXPECT_TRUE(d.closed && d.closed_as_wound);  // the winding number is 0 everywhere
  EXPECT_EQ(d.volume, 0);
}

TEST(Diagnosis, Box) {
  const Diagnosis d = diagnosis_of(unit_box());
  EXPECT_EQ(d.triangles, 12);
  EXPECT_EQ(d.vertices, 8);
  EXPECT_EQ(d.components, 1);
  EXPECT_TRUE(d.closed && d.closed_as_wound);
  EXPECT_EQ(all_defects(d), 0);
  EXPECT_EQ(d.volume, 1);
  EXPECT_EQ(d.lower, glm::dvec3(0));
  EXPECT_EQ(d.upper, glm::dvec3(1));
  EXPECT_EQ(d.largest_coordinate, 1);
  EXPECT_EQ(d.shortest_edge, 1);
  EXPECT_EQ(d.float_spacing, 0x1p-24);  // spacing of floats from 0.5 to 1
  EXPECT_EQ(d.vertices_lost + d.triangles_lost, 0);
}

TEST(Diagnosis, BoxOfSeparateTriangles) {
  const TriangleSoup box = unit_box();
  TriangleSoup apart;
  for (const Triangle& t : box.triangles) {
    append(apart, soup({box.positions[t[0]], box.positions[t[1]], box.positions[t[2]]}, {{0, 1, 2}}));
  }
  const Diagnosis d = diagnosis_of(apart);
  EXPECT_EQ(d.vertices, 8);
  EXPECT_TRUE(d.closed_as_wound);
  EXPECT_EQ(all_defects(d), 0);
}

TEST(Diagnosis, BoxWithATurnedTriangle) {
  TriangleSoup box = unit_box();
  std::swap(box.triangles[5][1], box.triangles[5][2]);
  const Diagnosis d = diagnosis_of(box);
  EXPECT_TRUE(d.closed);
  EXPECT_FALSE(d.closed_as_wound);
  EXPECT_EQ(d.inconsistent_windings.count, 3);
  EXPECT_EQ(all_defects(d), 3);
  for (const DefectPlace& place : d.inconsistent_windings.first) EXPECT_THAT(place.triangles, testing::Contains(5u));
}

TEST(Diagnosis, BoxInsideOut) {
  TriangleSoup box = unit_box();
  for (Triangle& t : box.triangles) std::swap(t[1], t[2]);
  const Diagnosis d = diagnosis_of(box);
  EXPECT_TRUE(d.closed && d.closed_as_wound);
  EXPECT_EQ(all_defects(d), 0);
  EXPECT_EQ(d.volume, -1);
}

TEST(Diagnosis, BoxWithoutATriangle) {
  TriangleSoup box = unit_box();
  box.triangles.pop_back();
  const Diagnosis d = diagnosis_of(box);
  EXPECT_FALSE(d.closed || d.closed_as_wound);
  EXPECT_EQ(d.boundary_edges.count, 3);
  EXPECT_EQ(d.boundary_loops, 1);
  EXPECT_EQ(all_defects(d), 4);
}

TEST(Diagnosis, OpenSheet) {
  const Diagnosis d = diagnosis_of(make_grid({.half_u = {4, 0, 0}, .half_v = {0, 0, 4}, .cells_u = 4, .cells_v = 4}));
  EXPECT_FALSE(d.closed || d.closed_as_wound);
  EXPECT_EQ(d.boundary_edges.count, 16);
  EXPECT_EQ(d.boundary_loops, 1);
  EXPECT_EQ(all_defects(d), 17);
  EXPECT_EQ(d.volume, 0);
}

TEST(Diagnosis, TubeHasTwoLoops) {
  const Diagnosis d = diagnosis_of(make_cylinder({.segments = 8, .capped = false}));
  EXPECT_FALSE(d.closed);  // though the loops' areas cancel
  EXPECT_EQ(d.boundary_edges.count, 16);
  EXPECT_EQ(d.boundary_loops, 2);
}

TEST(Diagnosis, DoubledSheetIsNotClosed) {
  TriangleSoup sheet = make_grid({.half_u = {2, 0, 0}, .half_v = {0, 0, 2}, .cells_u = 2, .cells_v = 2});
  append(sheet, sheet);
  const Diagnosis same = diagnosis_of(sheet);
  EXPECT_FALSE(same.closed || same.closed_as_wound);
  EXPECT_EQ(same.duplicate_faces.count, 8);
  EXPECT_EQ(same.opposite_faces.count, 0);
  EXPECT_EQ(same.boundary_edges.count, 0);
  EXPECT_EQ(same.non_manifold_edges.count, 8);     // edges inside the sheet
  EXPECT_EQ(same.inconsistent_windings.count, 8);  // edges along the rim
  // Each of the 8 triangles intersects its own copy; with the other copies it shares only an edge or a vertex.
  EXPECT_EQ(same.self_intersections->count, 8);

  for (std::size_t i = 8; i < 16; ++i) std::swap(sheet.triangles[i][1], sheet.triangles[i][2]);
  const Diagnosis opposite = diagnosis_of(sheet);
  EXPECT_TRUE(opposite.closed && opposite.closed_as_wound);
  EXPECT_EQ(opposite.duplicate_faces.count, 0);
  EXPECT_EQ(opposite.opposite_faces.count, 8);
  EXPECT_EQ(opposite.inconsistent_windings.count, 0);
  EXPECT_THAT(opposite.opposite_faces.first[3].triangles, ElementsAre(3, 11));
}

TEST(Diagnosis, ThreeOfOneWindingAndTwoOfTheOther) {
  const Diagnosis d =
      diagnosis_of(soup({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}}));
  EXPECT_EQ(d.duplicate_faces.count, 3);
  EXPECT_EQ(d.opposite_faces.count, 2);
  EXPECT_EQ(d.self_intersections->count, 10);  // every pair of triangles
  EXPECT_EQ(d.components, 1);
}

TEST(Diagnosis, MoebiusStrip) {
  TriangleSoup strip;
  constexpr std::uint32_t kCells = 12;
  for (std::uint32_t i = 0; i < kCells; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCells;
    for (const double side : {-0.4, 0.4}) {
      const double r = 2 + side * std::cos(angle / 2);
      strip.positions.emplace_back(r * std::cos(angle), side * std::sin(angle / 2), r * std::sin(angle));
    }
    const std::uint32_t a = 2 * i, b = 2 * i + 1;
    const bool last = i + 1 == kCells;  // the two sides of the strip change places here
    const std::uint32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    strip.triangles.push_back({a, b, c});
    strip.triangles.push_back({c, b, d});
  }
  const Diagnosis d = diagnosis_of(strip);
  EXPECT_EQ(d.boundary_edges.count, 2 * kCells);
  EXPECT_EQ(d.boundary_loops, 1);
  EXPECT_EQ(d.inconsistent_windings.count, 1);
  EXPECT_EQ(d.components, 1);
  EXPECT_FALSE(d.closed);
  EXPECT_EQ(all_defects(d), 2 * kCells + 2);
}

TEST(Diagnosis, ProjectivePlaneHasNoBoundaryYetIsNotClosed) {
  // Six vertices, and two triangles at each edge, but no winding on which all of them agree. In space it must cross
  // itself.
  const std::vector<glm::dvec3> p = {{0, 0, 8}, {1, 5, 2}, {5, 1, 3}, {4, -4, 1}, {-3, -5, 4}, {-6, 2, 0}};
  const Diagnosis d = diagnosis_of(soup(
      p,
      {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 1}, {1, 2, 4}, {2, 3, 5}, {3, 4, 1}, {4, 5, 2}, {5, 1, 3}}));
  EXPECT_EQ(d.boundary_edges.count + d.non_manifold_edges.count + d.non_manifold_vertices.count, 0);
  EXPECT_GT(d.inconsistent_windings.count, 0);
  EXPECT_GT(d.self_intersections->count, 0);
  EXPECT_FALSE(d.closed || d.closed_as_wound);
}

TEST(Diagnosis, Bowtie) {
  const Diagnosis d =
      diagnosis_of(soup({{0, 0, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}));
  EXPECT_EQ(d.non_manifold_vertices.count, 1);
  EXPECT_THAT(d.non_manifold_vertices.first[0].points, ElementsAre(glm::dvec3(0)));
  EXPECT_THAT(d.non_manifold_vertices.first[0].triangles, ElementsAre(0, 1));
  EXPECT_EQ(d.components, 2);
  EXPECT_EQ(d.boundary_loops, 2);  // the triangles only touch
  EXPECT_EQ(d.self_intersections->count, 0);
}

TEST(Diagnosis, ThreePages) {
  const Diagnosis d =
      diagnosis_of(soup({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}));
  EXPECT_EQ(d.non_manifold_edges.count, 1);
  EXPECT_THAT(d.non_manifold_edges.first[0].triangles, ElementsAre(0, 1, 2));
  EXPECT_EQ(d.non_manifold_vertices.count, 0);  // the triangles are one fan, linked through the common edge
  EXPECT_EQ(d.boundary_edges.count, 6);
  EXPECT_EQ(d.boundary_loops, 1);
  EXPECT_EQ(d.self_intersections->count, 0);
}

TEST(Diagnosis, FinOnABox) {
  TriangleSoup box = unit_box();
  append(box, soup({{0, 1, 0}, {1, 1, 0}, {0.5, 2, 0}}, {{0, 1, 2}}));  // the fin stands on an edge of the top
  const Diagnosis d = diagnosis_of(box);
  EXPECT_EQ(d.non_manifold_edges.count, 1);
  EXPECT_EQ(d.boundary_edges.count, 2);
  EXPECT_EQ(d.boundary_loops, 1);
  EXPECT_FALSE(d.closed || d.closed_as_wound);
  EXPECT_EQ(d.components, 1);
  EXPECT_EQ(d.self_intersections->count, 0);
}

TEST(Diagnosis, TwoBoxesThatShareAnEdge) {
  TriangleSoup boxes = unit_box();
  append(boxes, moved(unit_box(), {1, 1, 0}));
  const Diagnosis d = diagnosis_of(boxes);
  EXPECT_EQ(d.vertices, 14);
  EXPECT_EQ(d.components, 1);
  EXPECT_EQ(d.non_manifold_edges.count, 1);
  EXPECT_EQ(d.non_manifold_vertices.count,
            0);  // one fan at each end of the common edge, whose four triangles are linked
  EXPECT_TRUE(d.closed && d.closed_as_wound);
  EXPECT_EQ(all_defects(d), 1);
  EXPECT_EQ(d.volume, 2);
}

TEST(Diagnosis, TwoBoxesThatShareACorner) {
  TriangleSoup boxes = unit_box();
  append(boxes, moved(unit_box(), {1, 1, 1}));
  const Diagnosis d = diagnosis_of(boxes);
  EXPECT_EQ(d.vertices, 15);
  EXPECT_EQ(d.components, 2);
  EXPECT_EQ(d.non_manifold_vertices.count, 1);
  EXPECT_TRUE(d.closed && d.closed_as_wound);
  EXPECT_EQ(all_defects(d), 1);
}

}  // namespace
}  // namespace penumbra::mesh
