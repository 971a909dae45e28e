// SPDX-License-Identifier: Apache-2.0
// Compares the diagnosis of random lattice soups with the definitions applied by brute force, and tests that it does
// not depend on order, winding or numbering.

#include "tests/property/mesh/diagnosis_oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace penumbra::mesh {
namespace {

using oracle::Corners;
using oracle::counts_of;
using oracle::Point;

TriangleSoup soup_of(const std::vector<Corners>& triangles) {
  TriangleSoup soup;
  for (const Corners& corners : triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const Point& p : corners) soup.positions.emplace_back(p.x, p.y, p.z);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

Diagnosis diagnosed(const TriangleSoup& soup) {
  return diagnose({soup.positions, soup.triangles});
}

class Soups : public testing::TestWithParam<std::uint32_t> {
 protected:
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  Point lattice_point(int cells) {
    const std::int64_t step = 8 / cells;
    return {step * below(cells + 1), step * below(cells + 1), std::int64_t{2} * below(3)};
  }

  std::vector<Corners> random_soup(int triangles, int cells) {
    std::vector<Corners> soup;
    for (int i = 0; i < triangles; ++i) {
      soup.push_back({lattice_point(cells), lattice_point(cells), lattice_point(cells)});
    }
    return soup;
  }

  /// Returns sums of tetrahedra, closed as wound, some inside out. Some edges are split, if their middle is on the
  /// lattice, for one of their triangles only.
  std::vector<Corners> closed_soup(int tetrahedra, int splits) {
    std::vector<Corners> soup;
    for (int i = 0; i < tetrahedra; ++i) {
      const Point a = lattice_point(2), b = lattice_point(2), c = lattice_point(2), d = lattice_point(2);
      for (const Corners& face : {Corners{a, b, c}, {a, c, d}, {a, d, b}, {b, d, c}}) soup.push_back(face);
    }
    for (int i = 0; i < splits; ++i) {
      const auto t = static_cast<std::size_t>(below(static_cast<int>(soup.size())));
      Corners corners = soup[t];
      std::rotate(corners.begin(), corners.begin() + below(3), corners.end());
      const auto [a, b, c] = corners;
      if ((a.x + b.x) % 2 != 0 || (a.y + b.y) % 2 != 0 || (a.z + b.z) % 2 != 0) continue;
      const Point middle = {(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2};
      soup[t] = {a, middle, c};
      soup.push_back({middle, b, c});
      if (below(3) == 0) soup.push_back({a, b, middle});  // a triangle without area, which joins the halves to the edge
    }
    return soup;
  }

  /// Turns over about a third of the triangles.
  std::vector<Corners> wound_at_random(std::vector<Corners> soup) {
    for (Corners& t : soup) {
      if (below(3) == 0) std::swap(t[1], t[2]);
    }
    return soup;
  }

  std::mt19937 random_{GetParam()};
};

void expect_definition(const std::vector<Corners>& soup) {
  const Diagnosis diagnosis = diagnosed(soup_of(soup));
  EXPECT_EQ(counts_of(diagnosis), oracle::count(soup));
  EXPECT_EQ(diagnosis.self_intersections.value().count, oracle::count_self_intersections(soup));
}

TEST_P(Soups, FollowTheDefinitions) {
  expect_definition(random_soup(2 + below(24), 1 << below(3)));
}

TEST_P(Soups, ClosedOnesFollowTheDefinitions) {
  const std::vector<Corners> soup = closed_soup(1 + below(3), below(8));
  expect_definition(soup);
  expect_definition(wound_at_random(soup));
  EXPECT_TRUE(diagnosed(soup_of(soup)).closed_as_wound);
}

TEST_P(Soups, ATriangleTooFewOpensThem) {
  std::vector<Corners> soup = closed_soup(1 + below(3), below(8));
  const auto t = static_cast<std::size_t>(below(static_cast<int>(soup.size())));
  const bool flat = oracle::count({soup[t]}).zero_area_triangles == 1;
  soup.erase(soup.begin() + static_cast<std::ptrdiff_t>(t));
  EXPECT_EQ(diagnosed(soup_of(soup)).closed_as_wound, flat);
}

TEST_P(Soups, ManyTrianglesAtAVertexFollowTheDefinition) {
  if (GetParam() % 8 != 0) return;  // only a few seeds, as exact constructions are slow
  std::vector<Corners> soup = random_soup(20, 2);
  const Point hub = lattice_point(2), other = lattice_point(2);
  for (int i = 0; i < 90; ++i) soup.push_back({i % 4 == 0 ? other : hub, lattice_point(4), lattice_point(4)});
  std::ranges::shuffle(soup, random_);
  EXPECT_EQ(diagnosed(soup_of(soup)).self_intersections.value().count, oracle::count_self_intersections(soup));
}

TEST_P(Soups, CrowdedLinesFollowTheDefinition) {
  if (GetParam() % 8 != 0) return;  // only a few seeds, as this is slow
  // Three lines, two of which cross, with so many vertices on them that edges are counted by their positions on the
  // line.
  const auto on_a_line = [&] {
    const std::int64_t at = below(60);
    return std::array{Point{at, 0, 0}, Point{30, at - 30, 0}, Point{at, 2 * at, 7}}[static_cast<std::size_t>(below(3))];
  };
  std::vector<Corners> soup;
  for (int i = 0; i < 150; ++i) soup.push_back({on_a_line(), on_a_line(), on_a_line()});
  const TriangleSoup triangles = soup_of(soup);
  const MeshView mesh{triangles.positions, triangles.triangles};
  const Defect all = diagnose(mesh, {.search_intersections = false, .list_limit = 1'000'000}).t_junctions;
  EXPECT_EQ(all.count, oracle::count(soup).t_junctions);
  ASSERT_EQ(all.first.size(), all.count);
  const Defect few = diagnose(mesh, {.search_intersections = false, .list_limit = 40}).t_junctions;
  EXPECT_EQ(few.count, all.count);
  ASSERT_EQ(few.first.size(), 40u);
  for (std::size_t i = 0; i < few.first.size(); ++i) {
    EXPECT_EQ(few.first[i].triangles, all.first[i].triangles) << i;
    EXPECT_EQ(few.first[i].points, all.first[i].points) << i;
  }
}

TEST_P(Soups, OrderStartAndNamesOfCornersDoNotMatter) {
  std::vector<Corners> soup = below(2) == 0 ? random_soup(60, 4) : wound_at_random(closed_soup(6, 12));
  const Diagnosis before = diagnosed(soup_of(soup));
  std::ranges::shuffle(soup, random_);
  for (Corners& t : soup) std::rotate(t.begin(), t.begin() + below(3), t.end());
  TriangleSoup shared = soup_of(soup);  // the same soup with positions that several triangles share, some of them −0
  for (Triangle& t : shared.triangles) {
    for (std::uint32_t& corner : t) {
      if (below(2) == 0) continue;
      const auto same = std::ranges::find(shared.positions, shared.positions[corner]);
      corner = static_cast<std::uint32_t>(same - shared.positions.begin());
    }
  }
  for (glm::dvec3& p : shared.positions) {
    if (p.x == 0 && below(2) == 0) p.x = -0.0;
  }
  const Diagnosis after = diagnosed(shared);
  EXPECT_EQ(counts_of(before), counts_of(after));
  EXPECT_EQ(before.self_intersections->count, after.self_intersections->count);
  EXPECT_EQ(before.needles.count, after.needles.count);
  EXPECT_EQ(before.shortest_edge, after.shortest_edge);
}

TEST_P(Soups, WindingChangesOnlyWindingDuplicateAndClosednessResults) {
  const std::vector<Corners> soup = random_soup(60, 4);
  oracle::Counts before = counts_of(diagnosed(soup_of(soup)));
  oracle::Counts after = counts_of(diagnosed(soup_of(wound_at_random(soup))));
  for (oracle::Counts* counts : {&before, &after}) {
    counts->inconsistent_windings = counts->duplicate_faces = counts->opposite_faces = 0;
    counts->closed = counts->closed_as_wound = false;
  }
  EXPECT_EQ(before, after);
}

TEST_P(Soups, ScalingByAPowerOfTwoChangesNothing) {
  const std::vector<Corners> soup = random_soup(40, 4);
  const Diagnosis before = diagnosed(soup_of(soup));
  for (const double scale : {0x1p-400, 0x1p-60, 0x1p100, 0x1p300}) {
    TriangleSoup scaled = soup_of(soup);
    for (glm::dvec3& p : scaled.positions) p *= scale;
    const Diagnosis after = diagnosed(scaled);
    EXPECT_EQ(counts_of(before), counts_of(after)) << scale;
    EXPECT_EQ(before.self_intersections->count, after.self_intersections->count) << scale;
    EXPECT_EQ(before.needles.count, after.needles.count) << scale;
  }
}

TEST_P(Soups, LimitedListsArePrefixesOfFullLists) {
  const TriangleSoup soup = soup_of(random_soup(80, 4));
  const MeshView mesh{soup.positions, soup.triangles};
  const Diagnosis all = diagnose(mesh, {.list_limit = std::numeric_limits<std::size_t>::max()});
  const Diagnosis few = diagnose(mesh, {.list_limit = 3});
  const auto expect_prefix = [](const Defect& whole, const Defect& part) {
    EXPECT_EQ(whole.count, part.count);
    ASSERT_EQ(whole.first.size(), whole.count);
    ASSERT_EQ(part.first.size(), std::min<std::size_t>(3, whole.count));
    for (std::size_t i = 0; i < whole.first.size(); ++i) {
      EXPECT_LE(whole.first[i > 0 ? i - 1 : 0].triangles, whole.first[i].triangles);
      if (i >= part.first.size()) continue;
      EXPECT_EQ(whole.first[i].triangles, part.first[i].triangles);
      EXPECT_EQ(whole.first[i].points, part.first[i].points);
    }
  };
  expect_prefix(all.boundary_edges, few.boundary_edges);
  expect_prefix(all.non_manifold_edges, few.non_manifold_edges);
  expect_prefix(all.non_manifold_vertices, few.non_manifold_vertices);
  expect_prefix(all.inconsistent_windings, few.inconsistent_windings);
  expect_prefix(all.duplicate_faces, few.duplicate_faces);
  expect_prefix(all.opposite_faces, few.opposite_faces);
  expect_prefix(all.zero_area_triangles, few.zero_area_triangles);
  expect_prefix(all.needles, few.needles);
  expect_prefix(all.t_junctions, few.t_junctions);
  expect_prefix(*all.self_intersections, *few.self_intersections);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Soups, testing::Range(1u, 101u));

}  // namespace
}  // namespace penumbra::mesh
