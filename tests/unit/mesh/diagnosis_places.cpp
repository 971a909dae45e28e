// SPDX-License-Identifier: Apache-2.0
// Tests diagnoses of meshes small enough to count by hand that depend on positions: T-junctions, coincident patches,
// areas, intersections, lost precision.

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

/// Returns a tetrahedron over (0,0,0), (4,0,0), (0,4,0) whose base is cut in two at `cut`, on the edge y = 0, while the
/// adjacent side is not.
TriangleSoup cut_tetrahedron(const glm::dvec3& cut) {
  return soup({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, cut},
              {{0, 2, 4}, {4, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
}

TEST(Diagnosis, AcrossATJunctionItIsClosed) {
  const Diagnosis d = diagnosis_of(cut_tetrahedron({1, 0, 0}));
  EXPECT_TRUE(d.closed && d.closed_as_wound);
  EXPECT_EQ(d.t_junctions.count, 1);
  EXPECT_THAT(d.t_junctions.first[0].points, ElementsAre(glm::dvec3(1, 0, 0), glm::dvec3(0), glm::dvec3(4, 0, 0)));
  EXPECT_THAT(d.t_junctions.first[0].triangles, ElementsAre(2));
  EXPECT_EQ(d.boundary_edges.count, 3);
  EXPECT_EQ(d.boundary_loops, 1);
  EXPECT_DOUBLE_EQ(d.volume, 64.0 / 6);
}

TEST(Diagnosis, ACrackOfOneUlpIsNotClosed) {
  for (const glm::dvec3 crack : {glm::dvec3(1, 0x1p-1060, 0), glm::dvec3(1, 0, 0x1p-1060)}) {
    const Diagnosis d = diagnosis_of(cut_tetrahedron(crack));
    EXPECT_FALSE(d.closed || d.closed_as_wound);
    EXPECT_EQ(d.t_junctions.count, 0);
  }
}

TEST(Diagnosis, ACollinearTriangleBridgesATJunction) {
  TriangleSoup filled = cut_tetrahedron({1, 0, 0});
  filled.triangles.push_back({0, 4, 1});
  const Diagnosis d = diagnosis_of(filled);
  EXPECT_TRUE(d.closed && d.closed_as_wound);
  EXPECT_EQ(d.boundary_edges.count, 0);
  EXPECT_EQ(d.zero_area_triangles.count, 1);
  EXPECT_EQ(d.t_junctions.count, 1);  // the triangle that fills the gap leaves the long edge as it was
  EXPECT_EQ(d.components, 1);
}

TEST(Diagnosis, PatchesThatOnlyCoincideInSpaceCloseOneAnother) {
  // Six sides of a box, each a grid with its own number of cells: boundaries meet in T-junctions or not at all.
  const auto side = [](const glm::dvec3& centre, const glm::dvec3& u, const glm::dvec3& v, std::uint32_t cells) {
    return make_grid({.center = centre, .half_u = u, .half_v = v, .cells_u = cells, .cells_v = cells});
  };
  const glm::dvec3 x(60, 0, 0), y(0, 60, 0), z(0, 0, 60);
  TriangleSoup box = side(x, y, z, 1);
  append(box, side(-x, z, y, 2));
  append(box, side(y, z, x, 3));
  append(box, side(-y, x, z, 4));
  append(box, side(z, x, y, 5));
  append(box, side(-z, y, x, 6));
  const Diagnosis d = diagnosis_of(box);
  EXPECT_TRUE(d.closed && d.closed_as_wound);
  EXPECT_GT(d.t_junctions.count, 0);
  EXPECT_NEAR(d.volume, 120.0 * 120 * 120, 1e-6);
  std::swap(box.triangles[4][0],
            box.triangles[4][1]);  // one triangle turned back: now most of its patch is wound the other way
  EXPECT_TRUE(diagnosis_of(box).closed);
  EXPECT_FALSE(diagnosis_of(box).closed_as_wound);
}

TEST(Diagnosis, ZeroAreaAndNeedles) {
  const Diagnosis d = diagnosis_of(soup({{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {1, 0.0029, 0}, {1, 0.0031, 0}, {-0.0, 0, 0}},
                                        {{0, 1, 2}, {0, 2, 3}, {0, 2, 4}, {0, 5, 1}, {1, 1, 1}}));
  EXPECT_EQ(d.zero_area_triangles.count, 3);
  EXPECT_EQ(d.needles.count, 1);  // altitude 0.0029 on an edge of 3
  EXPECT_THAT(d.needles.first[0].triangles, ElementsAre(1));
  EXPECT_EQ(d.vertices, 5);
  EXPECT_EQ(d.components, 1);  // the three triangles that have edges share the edge from 0 to 2
  EXPECT_EQ(d.t_junctions.count, 1);
  EXPECT_EQ(d.shortest_edge, 1);  // from 0 to 1: a triangle that repeats a vertex has no edges
}

TEST(Diagnosis, SelfIntersections) {
  const TriangleSoup crossing =
      soup({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {9, 9, 0}}, {{0, 1, 2}, {3, 4, 5}});
  EXPECT_EQ(diagnosis_of(crossing).self_intersections->count, 1);
  EXPECT_EQ(diagnosis_of(crossing).self_intersections->first[0].points.size(), 6);
  EXPECT_FALSE(diagnosis_of(crossing, {.search_intersections = false}).self_intersections.has_value());

  // Neighbours that fold onto one another intersect; neighbours that only lie in one plane do not.
  EXPECT_EQ(diagnosis_of(soup({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 3, 0}}, {{0, 1, 2}, {0, 1, 3}}))
                .self_intersections->count,
            1);
  EXPECT_EQ(diagnosis_of(soup({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, -3, 0}}, {{0, 1, 2}, {0, 1, 3}}))
                .self_intersections->count,
            0);
  // A vertex that touches the inside of another triangle or edge also counts as an intersection.
  EXPECT_EQ(
      diagnosis_of(soup({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0}, {1, 1, 1}, {2, 1, 1}}, {{0, 1, 2}, {3, 4, 5}}))
          .self_intersections->count,
      1);
  // An edge from the common vertex runs through the other triangle's inside.
  EXPECT_EQ(diagnosis_of(soup({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {2, 2, -1}, {2, 2, 1}}, {{0, 1, 2}, {0, 3, 4}}))
                .self_intersections->count,
            1);
}

TEST(Diagnosis, ManyTrianglesInOnePlaceAreCountedAsOneSurface) {
  // n copies of one triangle and m copies of one that crosses it, alternating: 60,000 triangles have too many pairs to
  // visit.
  const std::uint64_t n = 40'000, m = 20'000;
  TriangleSoup heap = soup({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {9, 9, 0}}, {});
  for (std::uint64_t i = 0; i < n; ++i) {
    heap.triangles.push_back(i % 3 == 0 ? Triangle{1, 0, 2} : Triangle{2, 0, 1});
    if (i % 2 == 0) heap.triangles.push_back({3, 4, 5});
  }
  const Diagnosis d = diagnosis_of(heap, {.list_limit = 7});
  EXPECT_EQ(d.self_intersections->count, n * m + n * (n - 1) / 2 + m * (m - 1) / 2);
  ASSERT_EQ(d.self_intersections->first.size(), 7u);
  for (std::uint32_t i = 0; i < 7; ++i) EXPECT_THAT(d.self_intersections->first[i].triangles, ElementsAre(0, i + 1));
}

TEST(Diagnosis, FarFromTheOriginAndTinyDetailsAreLostInFloat) {
  // The box is around 2²⁵ with a spread of 2: relative to the centre nothing is lost.
  const glm::dvec3 far(0x1p25, 0, 0);
  const Diagnosis moved_far = diagnosis_of(moved(unit_box(), far));
  EXPECT_EQ(moved_far.largest_coordinate, 0x1p25 + 1);
  EXPECT_EQ(moved_far.vertices_lost + moved_far.triangles_lost, 0);
  EXPECT_EQ(moved_far.float_spacing, 0x1p-24);
  EXPECT_EQ(moved_far.volume, 1);

  // Two boxes 2²⁵ apart and 1/4 thick: at ±2²⁴ floats are 1 or 2 apart.
  TriangleSoup two = make_box({-0x1p24, 0, 0}, {0.125, 0x1p22, 0x1p22});
  append(two, make_box({0x1p24, 0, 0}, {0.125, 0x1p22, 0x1p22}));
  const Diagnosis flat = diagnosis_of(two);
  EXPECT_EQ(flat.float_spacing, 2);
  EXPECT_EQ(flat.vertices_lost, 8);    // one vertex of each pair across the thickness
  EXPECT_EQ(flat.triangles_lost, 16);  // all but the two large sides of each box
}

TEST(Diagnosis, WeldClosesACrack) {
  const TriangleSoup cracked = [] {
    TriangleSoup box = unit_box();
    box.positions.push_back(box.positions[box.triangles[0][0]] + glm::dvec3(1e-9, 0, 0));
    box.triangles[0][0] = static_cast<std::uint32_t>(box.positions.size() - 1);
    return box;
  }();
  EXPECT_FALSE(diagnosis_of(cracked).closed);
  const Diagnosis welded = diagnosis_of(cracked, {.weld = 1e-6});
  EXPECT_TRUE(welded.closed_as_wound);
  EXPECT_EQ(welded.vertices, 8);
}

TEST(Diagnosis, ProgressRisesToOne) {
  std::vector<double> shares;
  diagnosis_of(make_icosphere({0, 0, 0}, 1, 5), {.progress = [&](double share) { shares.push_back(share); }});
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_GT(shares.size(), 100);
  EXPECT_GT(shares.front(), 0);
  EXPECT_EQ(shares.back(), 1);
}

}  // namespace
}  // namespace penumbra::mesh
