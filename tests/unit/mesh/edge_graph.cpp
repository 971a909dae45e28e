// SPDX-License-Identifier: Apache-2.0
// Tests the edge graph against a few lines with std::map, on soups drawn from a tiny lattice, where doubled, degenerate
// and non-manifold triangles are the normal case.

#include "mesh/edge_graph.hpp"
#include "mesh/shapes/shapes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace penumbra::mesh {
namespace {

/// Returns the graph by its definition, in quadratic time.
EdgeGraph brute_force(const MeshView& mesh, double weld) {
  EdgeGraph graph;
  const std::size_t n = mesh.positions.size();
  graph.vertex.resize(n);
  for (std::uint32_t i = 0; i < n; ++i) graph.vertex[i] = i;
  for (bool changed = true; changed;) {  // the smallest number spreads along chains of close positions
    changed = false;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        const glm::dvec3 d = mesh.positions[i] - mesh.positions[j];
        const bool same = mesh.positions[i] == mesh.positions[j] || (weld > 0 && std::hypot(d.x, d.y, d.z) <= weld);
        if (!same || graph.vertex[i] <= graph.vertex[j]) continue;
        graph.vertex[i] = graph.vertex[j];
        changed = true;
      }
    }
  }
  std::map<Edge, std::vector<Incidence>> edges;
  std::map<Edge, std::uint32_t> number;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle corners = graph.corners(mesh.triangles[t]);
    const auto [a, b, c] = corners;
    const glm::dvec3 ab = mesh.positions[b] - mesh.positions[a], ac = mesh.positions[c] - mesh.positions[a];
    const bool repeated = a == b || b == c || c == a;
    const bool flat = ab.y * ac.z == ab.z * ac.y && ab.z * ac.x == ab.x * ac.z && ab.x * ac.y == ab.y * ac.x;
    graph.kind.push_back(repeated ? TriangleKind::repeated : flat ? TriangleKind::collinear : TriangleKind::proper);
    for (std::size_t i = 0; i < 3 && !repeated; ++i) {
      const std::uint32_t from = corners[i], to = corners[(i + 1) % 3];
      edges[{std::min(from, to), std::max(from, to)}].push_back({t, corners[(i + 2) % 3], from > to});
    }
  }
  for (const auto& [edge, around] : edges) {
    number[edge] = static_cast<std::uint32_t>(graph.edges.size());
    graph.edges.push_back(edge);
    graph.first.push_back(static_cast<std::uint32_t>(graph.incidences.size()));
    graph.incidences.insert(graph.incidences.end(), around.begin(), around.end());
  }
  graph.first.push_back(static_cast<std::uint32_t>(graph.incidences.size()));
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle corners = graph.corners(mesh.triangles[t]);
    std::array<std::uint32_t, 3> own = {EdgeGraph::kNoEdge, EdgeGraph::kNoEdge, EdgeGraph::kNoEdge};
    for (std::size_t i = 0; i < 3 && graph.kind[t] != TriangleKind::repeated; ++i) {
      const auto [a, b] = std::minmax(corners[i], corners[(i + 1) % 3]);
      own[i] = number.at({a, b});
    }
    graph.triangle_edges.push_back(own);
  }
  return graph;
}

void expect_same(const EdgeGraph& graph, const EdgeGraph& expected) {
  ASSERT_EQ(graph.vertex, expected.vertex);
  ASSERT_EQ(graph.kind, expected.kind);
  ASSERT_EQ(graph.edges, expected.edges);
  ASSERT_EQ(graph.first, expected.first);
  ASSERT_EQ(graph.incidences, expected.incidences);
  ASSERT_EQ(graph.triangle_edges, expected.triangle_edges);
}

struct Soup {
  std::vector<glm::dvec3> positions;
  std::vector<Triangle> triangles;
  [[nodiscard]] MeshView view() const { return {positions, triangles}; }
};

/// Coordinates are multiples of `step` up to 2 in size; every other zero is −0.
Soup lattice_soup(std::uint32_t seed, std::size_t triangles, double step = 1) {
  std::mt19937 random(seed);
  const int reach = static_cast<int>(std::round(2 / step));
  std::uniform_int_distribution<int> lattice(-reach, reach), coin(0, 1);
  const auto coordinate = [&] {
    const double value = step * lattice(random);
    return value == 0 && coin(random) == 0 ? -0.0 : value;
  };
  Soup soup;
  const std::size_t count = 3 + triangles / 2;
  for (std::size_t i = 0; i < count; ++i) soup.positions.emplace_back(coordinate(), coordinate(), coordinate());
  std::uniform_int_distribution<std::uint32_t> pick(0, static_cast<std::uint32_t>(count) - 1);
  for (std::size_t i = 0; i < triangles; ++i) soup.triangles.push_back({pick(random), pick(random), pick(random)});
  return soup;
}

class EdgeGraphOfLatticeSoup : public testing::TestWithParam<std::uint32_t> {};

TEST_P(EdgeGraphOfLatticeSoup, IsItsDefinition) {
  std::map<TriangleKind, int> kinds;
  std::size_t most_around = 0;
  for (const std::size_t triangles : {1U, 2U, 5U, 20U, 120U, 300U}) {
    const Soup soup = lattice_soup(GetParam() * 16 + static_cast<std::uint32_t>(triangles), triangles, 2);
    const EdgeGraph graph = build_edge_graph(soup.view());
    ASSERT_NO_FATAL_FAILURE(expect_same(graph, brute_force(soup.view(), 0))) << triangles << " triangles";
    for (const TriangleKind kind : graph.kind) ++kinds[kind];
    for (std::uint32_t e = 0; e < graph.edges.size(); ++e) most_around = std::max(most_around, graph.around(e).size());
  }
  EXPECT_GT(kinds[TriangleKind::proper], 50);
  EXPECT_GT(kinds[TriangleKind::collinear], 0);
  EXPECT_GT(kinds[TriangleKind::repeated], 2);
  EXPECT_GT(most_around, 2u) << "no edge with three triangles";
}

TEST_P(EdgeGraphOfLatticeSoup, WeldJoinsChainsWithinTheTolerance) {
  std::size_t joined = 0, kept = 0;
  for (const double weld :
       {0.25, 0.36, 0.5}) {  // along an axis; also a face's diagonal (√2/4 = 0.354…); two steps along an axis
    const Soup soup = lattice_soup(GetParam() + 500, 300, 0.25);
    const EdgeGraph graph = build_edge_graph(soup.view(), weld);
    ASSERT_NO_FATAL_FAILURE(expect_same(graph, brute_force(soup.view(), weld))) << "weld " << weld;
    for (std::uint32_t i = 0; i < graph.vertex.size(); ++i) ++(graph.vertex[i] == i ? kept : joined);
  }
  EXPECT_GT(joined, 5u);
  EXPECT_GT(kept, 5u);
}

INSTANTIATE_TEST_SUITE_P(Seeds, EdgeGraphOfLatticeSoup, testing::Range(0u, 20u));

TEST(EdgeGraph, NothingIsAGraphToo) {
  const EdgeGraph graph = build_edge_graph({});
  EXPECT_TRUE(graph.edges.empty());
  EXPECT_EQ(graph.first, std::vector<std::uint32_t>{0});
  const std::vector<glm::dvec3> lonely = {{1, 2, 3}, {1, 2, 3}};
  EXPECT_EQ(build_edge_graph({lonely, {}}).vertex, (std::vector<std::uint32_t>{0, 0}));
}

TEST(EdgeGraph, DoesNotDependOnTheNumberOfThreads) {
  const Soup soup = lattice_soup(7, 30000, 0.125);
  const EdgeGraph many = build_edge_graph(soup.view()), welded = build_edge_graph(soup.view(), 0.01);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  expect_same(build_edge_graph(soup.view()), many);
  expect_same(build_edge_graph(soup.view(), 0.01), welded);
  expect_same(many, welded);  // only equal coordinates are that close
}

TEST(EdgeGraph, DoesNotDependOnHowVerticesAreRepeated) {
  // If every corner has a separate position, the edges between places and the triangles around them are the same.
  const TriangleSoup blob = make_blob({.subdivisions = 3});
  std::vector<glm::dvec3> positions;
  std::vector<Triangle> triangles;
  for (const Triangle& t : blob.triangles) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    for (const std::uint32_t corner : t) positions.push_back(blob.positions[corner]);
    triangles.push_back({first, first + 1, first + 2});
  }
  const MeshView indexed_view{blob.positions, blob.triangles}, loose_view{positions, triangles};
  const EdgeGraph indexed = build_edge_graph(indexed_view), loose = build_edge_graph(loose_view);
  const auto places = [](const MeshView& view, const EdgeGraph& graph) {
    std::map<std::array<double, 6>, std::vector<std::uint32_t>> around;
    for (std::uint32_t e = 0; e < graph.edges.size(); ++e) {
      std::array<glm::dvec3, 2> ends = {view.positions[graph.edges[e].a], view.positions[graph.edges[e].b]};
      std::array<std::array<double, 3>, 2> key = {
          {{ends[0].x, ends[0].y, ends[0].z}, {ends[1].x, ends[1].y, ends[1].z}}};
      std::ranges::sort(key);
      auto& list = around[{key[0][0], key[0][1], key[0][2], key[1][0], key[1][1], key[1][2]}];
      for (const Incidence& incidence : graph.around(e)) list.push_back(incidence.triangle);
    }
    return around;
  };
  EXPECT_EQ(places(indexed_view, indexed), places(loose_view, loose));
  EXPECT_EQ(indexed.edges.size(), 3 * blob.triangles.size() / 2);
}

TEST(EdgeGraph, WidensFloatsExactly) {
  const std::vector<glm::vec3> floats = {{0.1f, -0.0f, 1e-45f}, {3e38f, 1, 2}};
  const std::vector<glm::dvec3> doubles = widened(floats);
  ASSERT_EQ(doubles.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(doubles[i][axis], static_cast<double>(floats[i][axis]));
  }
}

}  // namespace
}  // namespace penumbra::mesh
