// SPDX-License-Identifier: Apache-2.0
// Builds the edge graph of a triangle soup from its sorted sides: vertices merged by position, kinds of triangles by
// exact predicates. Not from a paper.

#include "mesh/edge_graph.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"
#include "mesh/predicates.hpp"
#include "mesh/sorted_sides.hpp"
#include "mesh/union_find.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace penumbra::mesh {
namespace {

/// Joins vertices within `weld` of each other, and chains of such vertices; the root is the first of each chain. Sweeps
/// along x, so the cost is n · (vertices within `weld` along x): meant for tolerances far below the spacing of
/// vertices.
void join_close(std::span<const glm::dvec3> positions, double weld, std::vector<std::uint32_t>& vertex) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < vertex.size(); ++i) {
    if (vertex[i] == i) order.push_back(i);
  }
  tbb::parallel_sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    return positions[i].x != positions[j].x ? positions[i].x < positions[j].x : i < j;
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const glm::dvec3& p = positions[order[i]];
    for (std::size_t j = i + 1; j < order.size() && positions[order[j]].x - p.x <= weld; ++j) {
      const glm::dvec3 d = positions[order[j]] - p;
      if (std::hypot(d.x, d.y, d.z) > weld) continue;
      const std::uint32_t a = find_root(vertex, order[i]), b = find_root(vertex, order[j]);
      vertex[std::max(a, b)] = std::min(a, b);
    }
  }
  for (std::uint32_t i = 0; i < vertex.size(); ++i) vertex[i] = find_root(vertex, i);
}

TriangleKind kind_of(std::span<const glm::dvec3> positions, const Triangle& corners) {
  const auto [a, b, c] = corners;
  if (a == b || b == c || c == a) return TriangleKind::repeated;
  return collinear(positions[a], positions[b], positions[c]) ? TriangleKind::collinear : TriangleKind::proper;
}

}  // namespace

EdgeGraph build_edge_graph(const MeshView& mesh, double weld) {
  PENUMBRA_ASSERT(weld >= 0 && std::isfinite(weld), "weld {}", weld);
  EdgeGraph graph;
  graph.vertex = merge_equal(mesh.positions);
  if (weld > 0) join_close(mesh.positions, weld, graph.vertex);

  const std::size_t triangle_count = mesh.triangles.size();
  graph.kind.resize(triangle_count);
  for_each_index(triangle_count,
                 [&](std::size_t t) { graph.kind[t] = kind_of(mesh.positions, graph.corners(mesh.triangles[t])); });

  const std::size_t vertices = mesh.positions.size();
  const SortedSides sorted = sort_sides(graph.vertex, mesh.triangles);
  std::vector<std::uint32_t> begun(vertices + 1, 0);  // first the number of edges that begin at each vertex, then the
                                                      // index of the first of them
  for_each_index(vertices, [&](std::size_t vertex) {
    const std::span<const SortedSide> here = sorted.from(vertex);
    for (std::size_t i = 0; i < here.size(); ++i) begun[vertex] += i == 0 || here[i].other != here[i - 1].other ? 1 : 0;
  });
  std::uint32_t edges = 0;
  for (std::uint32_t& number : begun) edges += std::exchange(number, edges);

  graph.edges.resize(edges);
  graph.first.assign(edges + std::size_t{1}, static_cast<std::uint32_t>(sorted.sides.size()));
  graph.incidences.resize(sorted.sides.size());
  graph.triangle_edges.assign(triangle_count, {EdgeGraph::kNoEdge, EdgeGraph::kNoEdge, EdgeGraph::kNoEdge});
  for_each_index(vertices, [&](std::size_t vertex) {
    std::uint32_t next = begun[vertex];
    for (std::uint32_t i = sorted.first[vertex]; i < sorted.first[vertex + 1]; ++i) {
      const auto [other, number] = sorted.sides[i];
      if (i == sorted.first[vertex] || other != sorted.sides[i - 1].other) {
        graph.edges[next] = {static_cast<std::uint32_t>(vertex), other};
        graph.first[next++] = i;
      }
      const std::uint32_t t = number / 3, corner = number % 3;
      graph.triangle_edges[t][corner] = next - 1;
      const Triangle corners = graph.corners(mesh.triangles[t]);
      graph.incidences[i] = {t, corners[(corner + 2) % 3], corners[corner] != vertex};
    }
  });
  return graph;
}

std::vector<glm::dvec3> widened(std::span<const glm::vec3> positions) {
  return {positions.begin(), positions.end()};
}

}  // namespace penumbra::mesh
