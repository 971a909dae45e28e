// SPDX-License-Identifier: Apache-2.0
// Tests repair of known defects, with the counts that it must report, and of random lattice soups, for which it must
// keep its promises: an oriented manifold by indices, the same points, its input unchanged, and nothing left for a
// second repair.

#include "repair/run_repair.hpp"

#include "base/error.hpp"
#include "mesh/shapes/shapes.hpp"
#include "tests/unit/mesh/soups.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

namespace penumbra::repair {
namespace {

namespace test = mesh::test;
using mesh::build_edge_graph;
using mesh::EdgeGraph;
using mesh::make_blob;
using mesh::make_icosphere;
using mesh::make_quad;
using mesh::make_sphere;
using mesh::make_torus;
using mesh::Repaired;
using mesh::RepairOptions;
using mesh::RepairStep;
using mesh::SphereShape;
using mesh::Triangle;
using mesh::TriangleKind;
using mesh::TriangleSoup;
using test::view;

std::uint64_t count_of(const Repaired& repaired, const std::string& word) {
  for (const RepairStep& step : repaired.done) {
    if (step.what.find(word) != std::string::npos) return step.count;
  }
  return 0;
}

std::string sentences(const Repaired& repaired) {
  std::string all;
  for (const RepairStep& step : repaired.done) all += step.what + "; ";
  for (const std::string& what : repaired.left) all += "LEFT " + what + "; ";
  return all;
}

/// Expects an oriented manifold: no directed edge twice, and one fan of triangles at each vertex. Returns the number of
/// open edges.
std::size_t expect_manifold(const TriangleSoup& soup) {
  std::set<std::pair<std::uint32_t, std::uint32_t> > directed;
  for (const Triangle& t : soup.triangles) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(directed.insert({t[i], t[(i + 1) % 3]}).second);
  }
  const auto open = std::ranges::count_if(directed, [&](const auto& edge) {
    return !directed.contains({edge.second, edge.first});
  });
  // From one triangle of a vertex (the first of an open fan), the walk around the vertex meets all of them.
  std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t> > next;
  for (const Triangle& t : soup.triangles) {
    for (std::size_t i = 0; i < 3; ++i) next[t[i]][t[(i + 1) % 3]] = t[(i + 2) % 3];
  }
  for (const auto& [vertex, ring] : next) {
    std::set<std::uint32_t> targets;
    for (const auto& [from, to] : ring) targets.insert(to);
    std::uint32_t at = ring.begin()->first;
    for (const auto& [from, to] : ring) {
      if (!targets.contains(from)) at = from;
    }
    std::size_t length = 0;
    for (auto step = ring.find(at); step != ring.end() && length < ring.size(); step = ring.find(step->second))
      ++length;
    EXPECT_EQ(length, ring.size()) << "vertex " << vertex << " has more than one fan";
  }
  return static_cast<std::size_t>(open);
}

double volume(const TriangleSoup& soup) {
  double sum = 0;
  for (const auto& [a, b, c] : soup.triangles) {
    sum += glm::dot(soup.positions[a], glm::cross(soup.positions[b], soup.positions[c])) / 6;
  }
  return sum;
}

bool same(const TriangleSoup& a, const TriangleSoup& b) {
  return a.positions == b.positions && a.triangles == b.triangles && a.object == b.object &&
         a.source_face == b.source_face;
}

/// Expects what every repair promises.
void expect_kept_promises(const TriangleSoup& soup, const Repaired& repaired, const RepairOptions& options) {
  const TriangleSoup& after = repaired.soup;
  ASSERT_EQ(after.object.size(), after.triangles.size());
  ASSERT_EQ(after.source_face.size(), after.triangles.size());
  std::set<std::pair<std::uint32_t, std::uint32_t> > names;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) names.emplace(soup.object[t], soup.source_face[t]);
  for (std::size_t t = 0; t < after.triangles.size(); ++t) {
    EXPECT_TRUE(names.contains({after.object[t], after.source_face[t]}));
  }
  if (!repaired.done.empty()) expect_manifold(after);
  const EdgeGraph graph = build_edge_graph(view(after));
  for (const TriangleKind kind : graph.kind) EXPECT_EQ(kind, TriangleKind::proper);
  const Repaired again = run_repair(after, options);
  EXPECT_TRUE(again.done.empty()) << "the second time: " << sentences(again) << " the first: " << sentences(repaired);
  EXPECT_TRUE(same(again.soup, after));
  EXPECT_EQ(again.left, repaired.left);
}

Repaired repair_and_check(const TriangleSoup& soup, const RepairOptions& options = {}) {
  Repaired repaired = run_repair(soup, options);
  expect_kept_promises(soup, repaired, options);
  return repaired;
}

TEST(Repair, LeavesWhatIsWhole) {
  for (const TriangleSoup& soup : {test::box(), make_torus({}), make_blob({})}) {
    const Repaired repaired = repair_and_check(soup, {.fill_holes_up_to = 100, .resolve_self_intersections = true});
    EXPECT_TRUE(repaired.done.empty()) << sentences(repaired);
    EXPECT_TRUE(repaired.left.empty()) << sentences(repaired);
    EXPECT_TRUE(same(repaired.soup, soup));
  }
}

TEST(Repair, MergesAndStitchesAShatteredBox) {
  const Repaired repaired = repair_and_check(test::shattered(test::box()));
  EXPECT_EQ(count_of(repaired, "merged"), 36u - 8u);
  EXPECT_EQ(count_of(repaired, "stitched"), 18u);
  EXPECT_EQ(repaired.done.size(), 2u) << sentences(repaired);
  EXPECT_TRUE(repaired.left.empty()) << sentences(repaired);
  EXPECT_EQ(repaired.soup.positions.size(), 8u);
  EXPECT_EQ(expect_manifold(repaired.soup), 0u);
}

TEST(Repair, WeldsWithinTheDistanceOnly) {
  TriangleSoup soup = test::shattered(test::box());
  for (std::size_t i = 0; i < 3; ++i) soup.positions[i].x += 0.001;
  EXPECT_FALSE(repair_and_check(soup).left.empty());
  const Repaired welded = repair_and_check(soup, {.weld = 0.01});
  EXPECT_TRUE(welded.left.empty()) << sentences(welded);
  EXPECT_EQ(welded.soup.positions.size(), 8u);
}

TEST(Repair, TurnsFlippedFacesAndInsideOutParts) {
  TriangleSoup soup = test::box();
  std::swap(soup.triangles[4][0], soup.triangles[4][1]);
  const Repaired one = repair_and_check(soup);
  EXPECT_EQ(count_of(one, "agree"), 1u);
  EXPECT_EQ(one.done.size(), 1u) << sentences(one);
  EXPECT_DOUBLE_EQ(volume(one.soup), 1);

  TriangleSoup inside_out = test::box();
  for (Triangle& t : inside_out.triangles) std::swap(t[0], t[1]);
  const Repaired all = repair_and_check(inside_out);
  EXPECT_EQ(count_of(all, "closed parts"), 1u);
  EXPECT_DOUBLE_EQ(volume(all.soup), 1);

  const TriangleSoup nested = test::together(test::box({-1, -1, -1}, {3, 3, 3}), test::box());
  const Repaired cavity = repair_and_check(nested);
  EXPECT_EQ(count_of(cavity, "closed parts"), 1u);
  EXPECT_DOUBLE_EQ(volume(cavity.soup), 26);
}

TEST(Repair, RemovesWhatHasNoAreaAndWhatRepeats) {
  TriangleSoup soup = test::box();
  const auto add = [&](const Triangle& t) {
    soup.triangles.push_back(t);
    soup.object.push_back(9);
    soup.source_face.push_back(9);
  };
  add({0, 0, 5});
  soup.positions.emplace_back(0.5, 0, 0);
  add({0, 8, 1});          // meets only an edge: no other triangle uses the edge's middle
  add(soup.triangles[3]);  // a copy of triangle 3
  add({soup.triangles[5][0], soup.triangles[5][2], soup.triangles[5][1]});  // a copy of triangle 5, wound the other way
  const Repaired repaired = repair_and_check(soup);
  EXPECT_EQ(count_of(repaired, "at one point"), 1u);
  EXPECT_EQ(count_of(repaired, "on a line"), 1u);
  EXPECT_EQ(count_of(repaired, "repeat"), 2u) << sentences(repaired);
  EXPECT_EQ(test::shattered(repaired.soup).positions, test::shattered(test::box()).positions);
  EXPECT_TRUE(repaired.left.empty()) << sentences(repaired);
}

TEST(Repair, ClosesTheCrackThatAZeroAreaTriangleLeaves) {
  // The box's edge 0-1 is split at its middle on one side only; a triangle without area fills the crack.
  TriangleSoup soup = test::box();
  soup.positions.emplace_back(0.5, 0, 0);
  soup = test::without_triangle(soup, 4);  // removes (0, 1, 5)
  for (const Triangle& t : {Triangle{0, 8, 5}, Triangle{8, 1, 5}, Triangle{0, 1, 8}}) {
    soup.triangles.push_back(t);
    soup.object.push_back(4);
    soup.source_face.push_back(4);
  }
  const Repaired repaired = repair_and_check(soup);
  EXPECT_EQ(count_of(repaired, "on a line"), 1u);
  EXPECT_EQ(count_of(repaired, "split 1 triangles at"), 1u) << sentences(repaired);
  EXPECT_EQ(repaired.soup.triangles.size(), 14u);
  EXPECT_EQ(expect_manifold(repaired.soup), 0u);
  EXPECT_DOUBLE_EQ(volume(repaired.soup), 1);
}

TEST(Repair, SplitsWhereSolidsTouch) {
  TriangleSoup at_vertex = test::together(test::box(), test::box({1, 1, 1}));
  for (Triangle& t : at_vertex.triangles) std::ranges::replace(t, 8u, 7u);  // one position for both
  const Repaired vertex = repair_and_check(at_vertex);
  EXPECT_EQ(count_of(vertex, "surfaces only touched"), 1u) << sentences(vertex);
  EXPECT_TRUE(vertex.left.empty()) << sentences(vertex);
  EXPECT_EQ(vertex.soup.positions.size(), 16u);

  TriangleSoup at_edge = test::together(test::box(), test::box({1, 1, 0}));  // both have (1, 1, 0)-(1, 1, 1)
  for (Triangle& t : at_edge.triangles) {
    std::ranges::replace(t, 8u, 3u);
    std::ranges::replace(t, 12u, 7u);
  }
  const Repaired edge = repair_and_check(at_edge);
  EXPECT_EQ(count_of(edge, "more triangles than a surface"), 1u) << sentences(edge);
  EXPECT_EQ(count_of(edge, "surfaces only touched"), 2u) << sentences(edge);
  EXPECT_TRUE(edge.left.empty()) << sentences(edge);
  EXPECT_DOUBLE_EQ(volume(edge.soup), 2);

  // Two boxes with a common wall and shared positions become two closed boxes again.
  const Repaired wall = repair_and_check(test::together(test::box(), test::box({1, 0, 0})));
  EXPECT_TRUE(wall.left.empty()) << sentences(wall);
  EXPECT_EQ(expect_manifold(wall.soup), 0u);
  EXPECT_DOUBLE_EQ(volume(wall.soup), 2);
}

TEST(Repair, FillsHolesUpToTheSizeAskedFor) {
  SphereShape sphere;
  sphere.segments = 12;
  sphere.rings = 8;
  TriangleSoup soup = make_sphere(sphere);
  std::erase_if(soup.triangles, [&](const Triangle& t) {  // removes the cap above the first ring: a hole of 12 edges
    return std::ranges::any_of(t, [&](std::uint32_t i) { return soup.positions[i].y > 0.99; });
  });
  soup.object.assign(soup.triangles.size(), 4);
  soup.source_face.assign(soup.triangles.size(), 7);
  const Repaired left = repair_and_check(soup, {.fill_holes_up_to = 11});
  EXPECT_EQ(count_of(left, "filled"), 0u);
  EXPECT_EQ(left.left, std::vector<std::string>{"12 edges are open: holes, rims of sheets, cracks"});
  const Repaired filled = repair_and_check(soup, {.fill_holes_up_to = 12});
  EXPECT_EQ(count_of(filled, "filled"), 1u) << sentences(filled);
  EXPECT_EQ(count_of(filled, "added"), 10u);
  EXPECT_TRUE(filled.left.empty()) << sentences(filled);
  EXPECT_EQ(expect_manifold(filled.soup), 0u);
}

TEST(Repair, FillsNoHoleByFoldingASheetOntoItself) {
  const TriangleSoup sheet = make_quad({0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  const Repaired repaired = repair_and_check(sheet, {.fill_holes_up_to = 10});
  EXPECT_TRUE(repaired.done.empty()) << sentences(repaired);
  EXPECT_EQ(repaired.left.size(), 2u) << sentences(repaired);
}

TEST(Repair, FillsNoHoleThroughWhatStandsInIt) {
  const TriangleSoup lidless = test::without_triangle(test::without_triangle(test::box(), 11), 10);
  EXPECT_EQ(count_of(repair_and_check(lidless, {.fill_holes_up_to = 4}), "filled"), 1u);
  const TriangleSoup pierced = test::together(lidless, test::box({0.5, 0.4, 0.4}, {2, 0.25, 0.25}));
  const Repaired repaired = repair_and_check(pierced, {.fill_holes_up_to = 4});
  EXPECT_EQ(count_of(repaired, "filled"), 0u);
  EXPECT_EQ(repaired.left.size(), 2u) << sentences(repaired);
}

TEST(Repair, SaysThatAMoebiusBandStaysCut) {
  const Repaired repaired = repair_and_check(test::moebius(12));
  EXPECT_EQ(repaired.soup.triangles.size(), 24u);
  ASSERT_FALSE(repaired.left.empty());
  EXPECT_NE(repaired.left[0].find("1 edges stay cut open"), std::string::npos) << sentences(repaired);
}

TEST(Repair, ResolvesALocalSelfIntersectionAndListsWhatItCannot) {
  TriangleSoup soup = make_icosphere({0, 0, 0}, 1, 4);  // 5,120 triangles, edges about 0.07 long
  const Triangle corners = soup.triangles[1000];
  glm::dvec3& moved = soup.positions[corners[0]];
  moved +=
      3.0 * (soup.positions[corners[1]] - moved);  // moves the vertex across its neighbours and out of their surface
  const Repaired repaired = repair_and_check(soup, {.resolve_self_intersections = true});
  EXPECT_GT(count_of(repaired, "resolved"), 0u) << sentences(repaired);
  EXPECT_TRUE(repaired.left.empty()) << sentences(repaired);
  EXPECT_EQ(expect_manifold(repaired.soup), 0u);

  const TriangleSoup boxes = test::together(test::box(), test::box({0.5, 0.3, 0.4}));
  const Repaired apart = repair_and_check(boxes, {.resolve_self_intersections = true});
  ASSERT_EQ(apart.left.size(), 1u) << sentences(apart);
  EXPECT_NE(apart.left[0].find("intersect still"), std::string::npos);
}

TEST(Repair, LatticeSoupsComeOutAsOrientedManifolds) {
  std::size_t changed = 0;
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const TriangleSoup soup = test::lattice_soup(seed, 4 + seed % 60, 1 + static_cast<int>(seed % 4));
    RepairOptions options;
    options.fill_holes_up_to = seed % 3 == 0 ? 6 : 0;
    options.resolve_self_intersections = seed % 4 == 1;
    changed += repair_and_check(soup, options).done.empty() ? 0 : 1;
  }
  EXPECT_GT(changed, 100u);
}

TEST(Repair, AnEmptySoupAndOneWithoutAreaComeOutEmpty) {
  EXPECT_TRUE(run_repair({}, {}).done.empty());
  const Repaired repaired = run_repair(test::soup_of({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}, {0, 0, 1}}), {});
  EXPECT_TRUE(repaired.soup.triangles.empty());
}

}  // namespace
}  // namespace penumbra::repair
