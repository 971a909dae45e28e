// SPDX-License-Identifier: Apache-2.0
// Tests signed multiplicities and silhouettes: against the definition in integers on lattice soups, against closed
// forms, that certain changes of the mesh do not matter; and the conservative list of edges that can be silhouettes.

#include "mesh/shapes/shapes.hpp"
#include "mesh/silhouettes.hpp"

#include <glm/common.hpp>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

namespace penumbra::mesh {
namespace {

using Place = std::array<int, 3>;

/// A soup on a lattice of integers, so that expected results can be computed in integers.
struct LatticeSoup {
  std::vector<Place> places;
  std::vector<Triangle> triangles;
  std::vector<glm::dvec3> positions;
  [[nodiscard]] MeshView view() const { return {positions, triangles}; }
};

glm::dvec3 position(const Place& place) {
  return {place[0], place[1], place[2]};
}

int draw(int low, int high) {
  return *rc::gen::inRange(low, high + 1);
}

LatticeSoup draw_soup(int most_triangles = 14, int reach = 2) {
  LatticeSoup soup;
  const int count = draw(3, 12);
  for (int i = 0; i < count; ++i)
    soup.places.push_back({draw(-reach, reach), draw(-reach, reach), draw(-reach, reach)});
  const int triangles = draw(1, most_triangles);
  for (int i = 0; i < triangles; ++i) {
    Triangle t{};
    for (std::uint32_t& corner : t) corner = static_cast<std::uint32_t>(draw(0, count - 1));
    soup.triangles.push_back(t);
  }
  for (const Place& place : soup.places) soup.positions.push_back(position(place));
  return soup;
}

int sign_of_volume(const Place& a, const Place& b, const Place& c, const Place& p) {
  const auto d = [&](const Place& q, std::size_t i) { return static_cast<std::int64_t>(q[i]) - a[i]; };
  const std::int64_t value = d(p, 0) * (d(b, 1) * d(c, 2) - d(b, 2) * d(c, 1)) +
                             d(p, 1) * (d(b, 2) * d(c, 0) - d(b, 0) * d(c, 2)) +
                             d(p, 2) * (d(b, 0) * d(c, 1) - d(b, 1) * d(c, 0));
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

using Multiplicities =
    std::map<std::pair<Place, Place>, int>;  // keyed by end points, the lesser one first; values are never 0

/// Computes the multiplicities by definition: a triangle with apex c gives the edge (a, b) the sign of (a, b, c; p).
Multiplicities by_definition(const LatticeSoup& soup, const Place& p) {
  Multiplicities k;
  for (const Triangle& t : soup.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      Place a = soup.places[t[i]], b = soup.places[t[(i + 1) % 3]];
      const Place c = soup.places[t[(i + 2) % 3]];
      if (b < a) std::swap(a, b);
      k[{a, b}] += sign_of_volume(a, b, c, p);
    }
  }
  std::erase_if(k, [](const auto& entry) { return entry.second == 0; });
  return k;
}

Multiplicities computed(const LatticeSoup& soup, const Place& p) {
  const EdgeGraph graph = build_edge_graph(soup.view());
  Multiplicities k;
  for (const SilhouetteEdge& s : silhouette_edges(soup.view(), graph, position(p))) {
    Place a = soup.places[graph.edges[s.edge].a], b = soup.places[graph.edges[s.edge].b];
    const int sense = b < a ? -1 : 1;
    if (sense < 0) std::swap(a, b);
    k[{a, b}] = sense * s.multiplicity;
  }
  return k;
}

Place draw_place() {
  return {draw(-4, 4), draw(-4, 4), draw(-4, 4)};
}

RC_GTEST_PROP(SignedMultiplicity, IsItsDefinition, ()) {
  const LatticeSoup soup = draw_soup();
  const Place p = draw_place();
  RC_ASSERT(computed(soup, p) == by_definition(soup, p));
}

RC_GTEST_PROP(SignedMultiplicity, DoesNotDependOnWindingOrderOrVertexNumbers, ()) {
  const LatticeSoup soup = draw_soup();
  const Place p = draw_place();
  LatticeSoup
      other;  // every corner a separate vertex, triangles in reverse order, some wound the other way, all rotated
  for (auto t = soup.triangles.rbegin(); t != soup.triangles.rend(); ++t) {
    const auto first = static_cast<std::uint32_t>(other.places.size());
    const std::size_t turn = static_cast<std::size_t>(draw(0, 2));
    Triangle corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      other.places.push_back(soup.places[(*t)[(i + turn) % 3]]);
      other.positions.push_back(position(other.places.back()));
      corners[i] = first + static_cast<std::uint32_t>(i);
    }
    if (draw(0, 1) == 1) std::swap(corners[1], corners[2]);
    other.triangles.push_back(corners);
  }
  RC_ASSERT(computed(other, p) == computed(soup, p));
}

RC_GTEST_PROP(SignedMultiplicity, WhatEntersAVertexLeavesIt, ()) {
  const LatticeSoup soup = draw_soup();
  const EdgeGraph graph = build_edge_graph(soup.view());
  std::map<std::uint32_t, int> net;
  for (const SilhouetteEdge& s : silhouette_edges(soup.view(), graph, position(draw_place()))) {
    net[graph.edges[s.edge].a] -= s.multiplicity;
    net[graph.edges[s.edge].b] += s.multiplicity;
  }
  for (const auto& [vertex, sum] : net) RC_ASSERT(sum == 0);
}

RC_GTEST_PROP(SignedMultiplicity, OppositeFacesOnlyAddUp, ()) {
  // A triangle and its copy wound the other way count alike: each multiplicity doubles.
  LatticeSoup soup = draw_soup();
  const Place p = draw_place();
  Multiplicities twice = computed(soup, p);
  for (auto& [edge, k] : twice) k *= 2;
  const std::size_t count = soup.triangles.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto [a, b, c] = soup.triangles[i];
    soup.triangles.push_back({a, c, b});
  }
  RC_ASSERT(computed(soup, p) == twice);
}

/// Around and inside a closed surface, multiplicities are only 0 and ±2. Silhouettes are loops: as many edges arrive at
/// each vertex as leave it. There are none if all triangles show the same side.
TEST(Silhouettes, OfClosedSurfacesAreTwofold) {
  for (const TriangleSoup& soup :
       {make_sphere({}), make_torus({}), make_blob({.subdivisions = 3}), make_box({0, 0, 0}, {1, 2, 3})}) {
    const MeshView view{soup.positions, soup.triangles};
    const EdgeGraph graph = build_edge_graph(view);
    for (const glm::dvec3& p : {glm::dvec3(5, 6, 7), glm::dvec3(-0.3, 9, 0.01), glm::dvec3(3.1, 0.2, -4)}) {
      const auto silhouettes = silhouette_edges(view, graph, p);
      EXPECT_GE(silhouettes.size(), 4u);
      EXPECT_LT(silhouettes.size(), graph.edges.size() / 2);
      for (const SilhouetteEdge& s : silhouettes) EXPECT_EQ(std::abs(s.multiplicity), 2);
    }
  }
  const TriangleSoup box = make_box({0, 0, 0}, {1, 2, 3});
  const MeshView view{box.positions, box.triangles};
  const EdgeGraph graph = build_edge_graph(view);
  EXPECT_TRUE(silhouette_edges(view, graph, {0.1, 0.2, 0.3}).empty()) << "from within a convex body";
  EXPECT_EQ(silhouette_edges(view, graph, {9, 8, 7}).size(), 6u) << "a box from a corner: a hexagon";
  EXPECT_EQ(silhouette_edges(view, graph, {9, 0.5, 0.5}).size(), 4u)
      << "a box seen from in front of a face: a quadrilateral";
}

TEST(Silhouettes, OfAnOpenSurfaceAreItsBorder) {
  const TriangleSoup soup = make_grid({.cells_u = 5, .cells_v = 7});
  const MeshView view{soup.positions, soup.triangles};
  const EdgeGraph graph = build_edge_graph(view);
  const auto silhouettes = silhouette_edges(view, graph, {0.2, 1, 0.3});
  EXPECT_EQ(silhouettes.size(), 2u * (5 + 7));
  for (const SilhouetteEdge& s : silhouettes) {
    EXPECT_EQ(std::abs(s.multiplicity), 1);
    EXPECT_EQ(graph.around(s.edge).size(), 1u);
  }
  EXPECT_TRUE(silhouette_edges(view, graph, {9, 0, 9}).empty()) << "a sheet seen edge-on has no silhouettes";
}

TEST(Silhouettes, BooksOfPagesCountTheirPages) {
  // n triangles around one edge, `behind` of them on its far side as seen from p, the others on p's side: k = n − 2 ·
  // behind.
  for (int pages = 1; pages <= 7; ++pages) {
    for (int behind = 0; behind <= pages; ++behind) {
      LatticeSoup soup;
      soup.places = {{0, 0, 0}, {0, 0, 1}};
      for (int i = 0; i < pages; ++i) {
        soup.places.push_back({i < behind ? -1 - i : 1 + i, 5, 0});
        soup.triangles.push_back({0, 1, static_cast<std::uint32_t>(2 + i)});
      }
      for (const Place& place : soup.places) soup.positions.push_back(position(place));
      const Multiplicities k = computed(soup, {0, 50, 0});
      const auto at = k.find({{0, 0, 0}, {0, 0, 1}});
      EXPECT_EQ(at == k.end() ? 0 : std::abs(at->second), std::abs(pages - 2 * behind));
    }
  }
}

/// Returns a point in the convex hull of the corners: weights are multiples of 1/8, so the coordinates are exact.
glm::dvec3 draw_in_hull(const std::vector<glm::dvec3>& corners) {
  glm::dvec3 sum(0);
  for (int i = 0; i < 8; ++i) sum += corners[static_cast<std::size_t>(draw(0, static_cast<int>(corners.size()) - 1))];
  return sum / 8.0;
}

std::vector<glm::dvec3> draw_corners(int most) {
  std::vector<glm::dvec3> corners;
  const int count = draw(1, most);
  for (int i = 0; i < count; ++i) corners.push_back(position(draw_place()));
  return corners;
}

RC_GTEST_PROP(PossibleSilhouettes, HoldEverySilhouetteFromTheHull, ()) {
  const LatticeSoup soup = draw_soup();
  const EdgeGraph graph = build_edge_graph(soup.view());
  const std::vector<glm::dvec3> corners = draw_corners(8);
  const std::vector<std::uint32_t> possible = possible_silhouette_edges(soup.view(), graph, corners);
  RC_ASSERT(std::ranges::is_sorted(possible));
  for (int i = 0; i < 12; ++i) {
    for (const SilhouetteEdge& s : silhouette_edges(soup.view(), graph, draw_in_hull(corners))) {
      RC_ASSERT(std::ranges::binary_search(possible, s.edge));
    }
  }
}

RC_GTEST_PROP(PossibleSilhouettes, FromOnePointAreItsSilhouettes, ()) {
  const LatticeSoup soup = draw_soup();
  const EdgeGraph graph = build_edge_graph(soup.view());
  const glm::dvec3 p = position(draw_place());
  std::vector<std::uint32_t> expected;
  for (const SilhouetteEdge& s : silhouette_edges(soup.view(), graph, p)) expected.push_back(s.edge);
  const std::vector<glm::dvec3> corners(static_cast<std::size_t>(draw(1, 3)), p);
  RC_ASSERT(possible_silhouette_edges(soup.view(), graph, corners) == expected);
}

RC_GTEST_PROP(PossibleSilhouettes, AreTightWhereNoTriangleIsSeenFromBothSides, ()) {
  // If each of an edge's triangles shows the whole hull one side, the edge is in the list iff it is a silhouette from
  // each point.
  const LatticeSoup soup = draw_soup();
  const EdgeGraph graph = build_edge_graph(soup.view());
  const std::vector<glm::dvec3> corners = draw_corners(4);
  std::vector<std::vector<Side>> seen;
  for (const glm::dvec3& corner : corners) seen.push_back(facings(soup.view(), graph, corner));
  const auto mixed = [&](const Incidence& incidence) {
    return std::ranges::any_of(
        seen, [&](const auto& sides) { return sides[incidence.triangle] != seen[0][incidence.triangle]; });
  };
  const std::vector<std::uint32_t> possible = possible_silhouette_edges(soup.view(), graph, corners);
  for (std::uint32_t e = 0; e < graph.edges.size(); ++e) {
    if (std::ranges::any_of(graph.around(e), mixed)) continue;
    RC_ASSERT(std::ranges::binary_search(possible, e) == (signed_multiplicity(graph, e, seen[0]) != 0));
  }
}

TEST(PossibleSilhouettes, OfAFlatGridAreItsBorder) {
  // Receivers on both sides of the grid: every triangle is seen from both sides, and inner edges still cancel.
  const TriangleSoup soup = make_grid({.half_u = {4, 0, 0}, .half_v = {0, 0, -4}, .cells_u = 8, .cells_v = 8});
  const MeshView view{soup.positions, soup.triangles};
  const EdgeGraph graph = build_edge_graph(view);
  const std::vector<glm::dvec3> across = {{-1, -1, -1}, {1, -1, 1}, {0.5, 2, 0.3}};
  const auto possible = possible_silhouette_edges(view, graph, across);
  EXPECT_EQ(possible.size(), 4u * 8);
  for (const std::uint32_t e : possible) EXPECT_EQ(graph.around(e).size(), 1u);
  const std::vector<glm::dvec3> within = {{-1, 0, -1}, {1, 0, 1}, {0, 0, 3}};
  EXPECT_TRUE(possible_silhouette_edges(view, graph, within).empty())
      << "a hull in the grid's plane sees the grid edge-on: no silhouettes";
}

TEST(PossibleSilhouettes, PagesOfAFlatBookCancelInPairs) {
  // Pages around one edge, all in one plane: as many to the left as to the right cancel as seen from any point; with
  // one page more they do not.
  LatticeSoup soup;
  soup.places = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {2, 0, 5}, {-1, 0, 0}, {-3, 0, 2}, {0, 1, 0}};
  soup.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {0, 1, 5}};
  for (const Place& place : soup.places) soup.positions.push_back(position(place));
  const std::vector<glm::dvec3> hull = {{0, -3, 0}, {1, 3, 0}, {0, 3, 1}};
  const auto holds_the_spine = [&] {
    const EdgeGraph graph = build_edge_graph(soup.view());
    const auto spine = std::ranges::find(graph.edges, Edge{0, 1}) - graph.edges.begin();
    return std::ranges::binary_search(possible_silhouette_edges(soup.view(), graph, hull),
                                      static_cast<std::uint32_t>(spine));
  };
  EXPECT_FALSE(holds_the_spine());
  soup.triangles.push_back({0, 1, 2});
  EXPECT_TRUE(holds_the_spine());
  soup.triangles.back() = {0, 1, 6};  // a page off the plane
  EXPECT_TRUE(holds_the_spine());
}

TEST(PossibleSilhouettes, OfABlobFromASmallLightAreFew) {
  // Nearly all triangles show one side to a light much smaller than its distance: the list is little longer than the
  // silhouette from its centre, and much shorter than the list of all edges.
  const TriangleSoup soup = make_blob({.subdivisions = 4});
  const MeshView view{soup.positions, soup.triangles};
  const EdgeGraph graph = build_edge_graph(view);
  const std::vector<glm::dvec3> light = {{-0.1, 5, -0.1}, {0.1, 5, -0.1}, {0.1, 5, 0.1}, {-0.1, 5, 0.1}};
  const std::size_t possible = possible_silhouette_edges(view, graph, light).size();
  const std::size_t center = silhouette_edges(view, graph, {0, 5, 0}).size();
  EXPECT_GT(possible, center);
  EXPECT_LT(possible, graph.edges.size() / 4);
}

}  // namespace
}  // namespace penumbra::mesh
