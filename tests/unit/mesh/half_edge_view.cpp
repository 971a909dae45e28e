// SPDX-License-Identifier: Apache-2.0
// Tests the half-edge view on shapes with known answers, and on random lattice soups against the definitions: held and
// listed faces are all faces, and the silhouette loops are exactly the signed multiplicities of the held faces, ties
// included.

#include "mesh/half_edge_view.hpp"

#include "mesh/shapes/shapes.hpp"
#include "mesh/silhouettes.hpp"
#include "tests/unit/mesh/soups.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace penumbra::mesh {
namespace {

using test::view;

HalfEdgeView half_edges(const TriangleSoup& soup) {
  return {view(soup), build_edge_graph(view(soup))};
}

std::size_t count(const HalfEdgeView& surface, NotHeld why) {
  return static_cast<std::size_t>(std::ranges::count(surface.listed(), why, &ListedFace::why));
}

/// Returns how often the loops run along each edge: from a to b, minus from b to a.
std::map<std::uint32_t, int> runs(const HalfEdgeView& surface, const EdgeGraph& graph,
                                  const std::vector<SurfaceLoop>& loops) {
  std::map<std::uint32_t, int> runs;
  for (const SurfaceLoop& loop : loops) {
    for (std::size_t i = 0; i < loop.edges.size(); ++i) {
      const std::uint32_t from = surface.point_of_vertex()[loop.vertices[i]];
      const std::uint32_t to = surface.point_of_vertex()[loop.vertices[(i + 1) % loop.vertices.size()]];
      const Edge& edge = graph.edges[loop.edges[i]];
      EXPECT_EQ(std::minmax(from, to), std::minmax(edge.a, edge.b)) << "an edge that does not join its vertices";
      runs[loop.edges[i]] += from == edge.a ? 1 : -1;
    }
  }
  return runs;
}

/// Expects that every triangle is held or listed, that the maps are each other's inverse, and that neighbours are wound
/// alike.
void expect_sound(const TriangleSoup& soup, const EdgeGraph& graph, const HalfEdgeView& surface) {
  std::set<std::uint32_t> triangles(surface.triangle_of_face().begin(), surface.triangle_of_face().end());
  for (const ListedFace& face : surface.listed()) EXPECT_TRUE(triangles.insert(face.triangle).second);
  EXPECT_EQ(triangles.size(), soup.triangles.size());
  EXPECT_EQ(surface.triangle_of_face().size() + surface.listed().size(), soup.triangles.size());
  std::set<std::pair<std::uint32_t, std::uint32_t>> directed;
  for (std::uint32_t face = 0; face < surface.triangle_of_face().size(); ++face) {
    const std::uint32_t t = surface.triangle_of_face()[face];
    EXPECT_EQ(surface.face_of_triangle()[t], face);
    const Triangle corners = surface.corners(face);
    Triangle points = graph.corners(soup.triangles[t]), held{};
    for (std::size_t i = 0; i < 3; ++i) {
      held[i] = surface.point_of_vertex()[corners[i]];
      EXPECT_TRUE(directed.insert({corners[i], corners[(i + 1) % 3]}).second)
          << "two faces traverse an edge in the same direction";
    }
    if (std::ranges::binary_search(surface.turned(), t)) std::swap(points[1], points[2]);
    const auto start = std::ranges::find(held, points[0]) - held.begin();
    std::rotate(held.begin(), held.begin() + start, held.end());
    EXPECT_EQ(held, points) << "triangle " << t;
  }
  std::uint32_t faces = 0;
  for (const SurfaceComponent& component : surface.components()) faces += component.faces;
  EXPECT_EQ(faces, surface.triangle_of_face().size());
}

/// Expects that k_e(p) over the held faces is the number of times that the front loops run along edge e, minus that of
/// the back loops.
void expect_loops_are_multiplicities(const TriangleSoup& soup, const EdgeGraph& graph, const HalfEdgeView& surface,
                                     const glm::dvec3& p) {
  std::vector<Side> sides = facings(view(soup), graph, p);
  auto front = runs(surface, graph, surface.silhouette_loops(sides, Side::front));
  auto back = runs(surface, graph, surface.silhouette_loops(sides, Side::back));
  for (const ListedFace& face : surface.listed()) sides[face.triangle] = Side::on;  // counts 0
  for (std::uint32_t edge = 0; edge < graph.edges.size(); ++edge) {
    EXPECT_EQ(signed_multiplicity(graph, edge, sides), front[edge] - back[edge]) << "edge " << edge;
  }
}

/// Returns the rims of holes and sheets: the loops around all faces.
std::vector<SurfaceLoop> boundary_loops(const HalfEdgeView& surface) {
  return surface.loops_around(std::vector<bool>(surface.triangle_of_face().size(), true));
}

TEST(HalfEdgeView, ABoxIsOneClosedComponent) {
  const TriangleSoup soup = test::shattered(test::box());
  const HalfEdgeView surface = half_edges(soup);
  EXPECT_TRUE(surface.listed().empty());
  EXPECT_TRUE(surface.turned().empty());
  EXPECT_EQ(surface.point_of_vertex().size(), 8u);
  ASSERT_EQ(surface.components().size(), 1u);
  EXPECT_TRUE(surface.components()[0].closed);
  EXPECT_TRUE(boundary_loops(surface).empty());
}

TEST(HalfEdgeView, FlippedFacesAreTurnedAndRecorded) {
  TriangleSoup soup = test::box();
  for (const std::size_t t : {0u, 5u, 7u}) std::swap(soup.triangles[t][0], soup.triangles[t][1]);
  const HalfEdgeView surface = half_edges(soup);
  EXPECT_EQ(std::vector(surface.turned().begin(), surface.turned().end()), (std::vector<std::uint32_t>{0, 5, 7}));
  expect_sound(soup, build_edge_graph(view(soup)), surface);
}

TEST(HalfEdgeView, FacesThatItCannotHoldAreListedWithTheReason) {
  TriangleSoup soup = test::soup_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {2, 0, 0}, {9, 9, 9}},
                                    {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {0, 1, 5}, {6, 6, 1}, {2, 3, 6}});
  const HalfEdgeView surface = half_edges(soup);
  const std::vector<ListedFace> expected = {{0, NotHeld::crowded_edge},
                                            {1, NotHeld::crowded_edge},
                                            {2, NotHeld::crowded_edge},
                                            {3, NotHeld::collinear},
                                            {4, NotHeld::repeated_vertex}};
  EXPECT_EQ(std::vector(surface.listed().begin(), surface.listed().end()), expected);
  EXPECT_EQ(surface.triangle_of_face().size(), 1u);
}

TEST(HalfEdgeView, AMoebiusBandLosesOneFaceAndBecomesADisk) {
  for (const std::uint32_t cells : {5u, 8u, 31u}) {
    const TriangleSoup soup = test::moebius(cells);
    const HalfEdgeView surface = half_edges(soup);
    EXPECT_EQ(count(surface, NotHeld::not_orientable), 1u) << cells;
    EXPECT_EQ(surface.triangle_of_face().size(), 2 * cells - 1);
    EXPECT_EQ(surface.components().size(), 1u);
    ASSERT_EQ(boundary_loops(surface).size(), 1u);
    EXPECT_EQ(boundary_loops(surface)[0].edges.size(), 2 * cells - 1 + 2);  // a strip of n triangles has n + 2 edges
    expect_sound(soup, build_edge_graph(view(soup)), surface);
  }
}

TEST(HalfEdgeView, AVertexIsSplitForEachFan) {
  const HalfEdgeView surface = half_edges(test::together(test::box(), test::box({1, 1, 1})));
  EXPECT_TRUE(surface.listed().empty());
  EXPECT_EQ(surface.point_of_vertex().size(), 16u);
  const std::set<std::uint32_t> points(surface.point_of_vertex().begin(), surface.point_of_vertex().end());
  EXPECT_EQ(points.size(), 15u);
  ASSERT_EQ(surface.components().size(), 2u);
  EXPECT_TRUE(surface.components()[0].closed && surface.components()[1].closed);
}

TEST(HalfEdgeView, BoundaryLoopsOfKnownShapes) {
  EXPECT_TRUE(boundary_loops(half_edges(make_torus({}))).empty());
  CylinderShape tube;
  tube.segments = 24;
  tube.capped = false;
  const auto rims = boundary_loops(half_edges(make_cylinder(tube)));
  ASSERT_EQ(rims.size(), 2u);
  EXPECT_EQ(rims[0].edges.size(), 24u);
  EXPECT_EQ(rims[1].edges.size(), 24u);
  GridShape grid;
  grid.cells_u = 5;
  grid.cells_v = 7;
  const auto sheet = boundary_loops(half_edges(make_grid(grid)));
  ASSERT_EQ(sheet.size(), 1u);
  EXPECT_EQ(sheet[0].edges.size(), 24u);
  const auto hole = boundary_loops(half_edges(test::without_triangle(test::box(), 3)));
  ASSERT_EQ(hole.size(), 1u);
  EXPECT_EQ(hole[0].edges.size(), 3u);
}

TEST(HalfEdgeView, SilhouettesOfClosedShapesAreTheSilhouetteEdges) {
  for (const TriangleSoup& soup : {make_torus({}), make_knot({}), make_blob({})}) {
    const EdgeGraph graph = build_edge_graph(view(soup));
    const HalfEdgeView surface(view(soup), graph);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> coordinate(-3, 3);
    for (int i = 0; i < 5; ++i) {
      const glm::dvec3 p(coordinate(random), coordinate(random), coordinate(random));
      const std::vector<Side> sides = facings(view(soup), graph, p);
      ASSERT_EQ(std::ranges::count(sides, Side::on), 0);
      std::map<std::uint32_t, int> expected;
      for (const SilhouetteEdge& edge : silhouette_edges(view(soup), graph, p)) {
        expected[edge.edge] = edge.multiplicity / 2;  // ±2: each edge once, in its direction
      }
      EXPECT_EQ(runs(surface, graph, surface.silhouette_loops(sides)), expected);
      EXPECT_FALSE(expected.empty());
    }
  }
}

TEST(HalfEdgeView, LatticeSoupsKeepEveryFaceAndEveryMultiplicityInSilence) {
  testing::internal::CaptureStderr();
  std::size_t held = 0, listed = 0;
  for (std::uint32_t seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const TriangleSoup soup = test::lattice_soup(seed, 4 + seed % 60, 1 + static_cast<int>(seed % 4));
    const EdgeGraph graph = build_edge_graph(view(soup));
    const HalfEdgeView surface(view(soup), graph);
    expect_sound(soup, graph, surface);
    EXPECT_EQ(count(surface, NotHeld::refused), 0u);
    expect_loops_are_multiplicities(soup, graph, surface,
                                    {1, 0, 2});  // a viewpoint on the lattice, in the planes of many triangles
    expect_loops_are_multiplicities(soup, graph, surface, {0.3, 5.1, -2.7});
    held += surface.triangle_of_face().size();
    listed += surface.listed().size();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_GT(held, 500u);  // otherwise the test would test nothing
  EXPECT_GT(listed, 500u);
}

TEST(HalfEdgeView, OpenAndTurnedSurfacesKeepEveryMultiplicity) {
  std::mt19937 random(3);
  for (TriangleSoup soup : {make_terrain({}), make_hair({}), test::moebius(20), make_torus({})}) {
    for (Triangle& t : soup.triangles) {
      if (random() % 3 == 0) std::swap(t[1], t[2]);
    }
    const EdgeGraph graph = build_edge_graph(view(soup));
    const HalfEdgeView surface(view(soup), graph);
    expect_sound(soup, graph, surface);
    expect_loops_are_multiplicities(soup, graph, surface, {0.3, 2.1, -0.7});
    expect_loops_are_multiplicities(soup, graph, surface, soup.positions[17]);
  }
}

}  // namespace
}  // namespace penumbra::mesh
