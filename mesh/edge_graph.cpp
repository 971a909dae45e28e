#include "mesh/edge_graph.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"
#include "mesh/predicates.hpp"
#include "mesh/union_find.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>

namespace penumbra::mesh {
namespace {

constexpr std::uint32_t kMostTriangles = 0xffffffffu / 3;  // a half-edge's number is 32 bits

struct Place {
  double x, y, z;
  std::uint32_t position;

  [[nodiscard]] bool same_point(const Place& other) const { return x == other.x && y == other.y && z == other.z; }
  bool operator<(const Place& other) const {
    if (x != other.x) return x < other.x;
    if (y != other.y) return y < other.y;
    if (z != other.z) return z < other.z;
    return position < other.position;
  }
};

/// For each position, the first one with the same coordinates.
std::vector<std::uint32_t> merge_equal(std::span<const glm::dvec3> positions) {
  std::vector<Place> places(positions.size());
  for_each_index(places.size(), [&](std::size_t i) {
    const glm::dvec3& p = positions[i];
    places[i] = {p.x, p.y, p.z, static_cast<std::uint32_t>(i)};
  });
  tbb::parallel_sort(places.begin(), places.end());
  std::vector<std::uint32_t> vertex(positions.size());
  std::uint32_t first = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i == 0 || !places[i].same_point(places[i - 1])) first = places[i].position;
    vertex[places[i].position] = first;
  }
  return vertex;
}

/// Joins vertices within `weld` of each other, and chains of them: the roots are the first of each chain. Sweeps along
/// x, so it costs n · (vertices within `weld` along x): meant for tolerances far below the spacing of vertices.
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

struct HalfEdge {
  Edge edge;
  std::uint32_t number;  // 3 · triangle + corner; kNoEdge's place at the end for triangles that repeat a vertex

  bool operator<(const HalfEdge& other) const { return edge != other.edge ? edge < other.edge : number < other.number; }
};

constexpr Edge kNowhere = {0xffffffffu, 0xffffffffu};

}  // namespace

EdgeGraph build_edge_graph(const MeshView& mesh, double weld) {
  PENUMBRA_ASSERT(mesh.triangles.size() <= kMostTriangles, "{} triangles", mesh.triangles.size());
  PENUMBRA_ASSERT(weld >= 0 && std::isfinite(weld), "weld {}", weld);
  EdgeGraph graph;
  graph.vertex = merge_equal(mesh.positions);
  if (weld > 0) join_close(mesh.positions, weld, graph.vertex);

  const std::size_t triangle_count = mesh.triangles.size();
  graph.kind.resize(triangle_count);
  std::vector<HalfEdge> half_edges(3 * triangle_count);
  for_each_index(triangle_count, [&](std::size_t t) {
    const Triangle corners = graph.corners(mesh.triangles[t]);
    graph.kind[t] = kind_of(mesh.positions, corners);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax(corners[i], corners[(i + 1) % 3]);
      half_edges[3 * t + i] = {graph.kind[t] == TriangleKind::repeated ? kNowhere : Edge{a, b},
                               static_cast<std::uint32_t>(3 * t + i)};
    }
  });
  tbb::parallel_sort(half_edges.begin(), half_edges.end());
  while (!half_edges.empty() && half_edges.back().edge == kNowhere) half_edges.pop_back();

  graph.incidences.resize(half_edges.size());
  graph.triangle_edges.assign(triangle_count, {EdgeGraph::kNoEdge, EdgeGraph::kNoEdge, EdgeGraph::kNoEdge});
  for (std::size_t i = 0; i < half_edges.size(); ++i) {
    const auto& [edge, number] = half_edges[i];
    if (i == 0 || edge != half_edges[i - 1].edge) {
      graph.edges.push_back(edge);
      graph.first.push_back(static_cast<std::uint32_t>(i));
    }
    const std::uint32_t t = number / 3, corner = number % 3;
    graph.triangle_edges[t][corner] = static_cast<std::uint32_t>(graph.edges.size() - 1);
    const Triangle corners = graph.corners(mesh.triangles[t]);
    graph.incidences[i] = {t, corners[(corner + 2) % 3], corners[corner] != edge.a};
  }
  graph.first.push_back(static_cast<std::uint32_t>(half_edges.size()));
  return graph;
}

std::vector<glm::dvec3> widened(std::span<const glm::vec3> positions) {
  return {positions.begin(), positions.end()};
}

}  // namespace penumbra::mesh
