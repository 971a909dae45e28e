#include "mesh/edge_graph.hpp"

#include "base/assert.hpp"
#include "base/buckets.hpp"
#include "base/parallel.hpp"
#include "mesh/predicates.hpp"
#include "mesh/union_find.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <compare>
#include <tuple>
#include <utility>

namespace penumbra::mesh {
namespace {

constexpr std::uint32_t kMostTriangles = 0xffffffffu / 3;  // a half-edge's number is 32 bits

/// Equal for equal points, and for few others. (Multiplying and folding as in splitmix64.)
std::uint64_t hash_of(const glm::dvec3& point) {
  std::uint64_t hash = 0x9e3779b97f4a7c15u;
  for (int axis = 0; axis < 3; ++axis) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(point[axis] + 0.0)) * 0xbf58476d1ce4e5b9u;  // + 0 turns −0 into +0
    hash ^= hash >> 31U;
  }
  return hash;
}

/// For each position, the first one with the same coordinates.
std::vector<std::uint32_t> merge_equal(std::span<const glm::dvec3> positions) {
  const std::size_t places = std::bit_ceil(std::max<std::size_t>(positions.size(), 1));
  Buckets alike =
      into_buckets(positions.size(), places, [&](std::size_t i) { return hash_of(positions[i]) & (places - 1); });
  std::vector<std::uint32_t> vertex(positions.size());
  for_each_index(alike.size(), [&](std::size_t bucket) {
    const std::span<std::uint32_t> here = alike[bucket];
    // By place, then by number, of which each place has the first. One point in a million copies is no reason to be
    // slow.
    const auto key = [&](std::uint32_t i) {
      const glm::dvec3& p = positions[i];
      return std::tuple(p.x, p.y, p.z, i);
    };
    if (here.size() > 1) std::ranges::sort(here, {}, key);
    for (std::size_t i = 0; i < here.size(); ++i) {
      const bool again = i > 0 && positions[here[i]] == positions[here[i - 1]];
      vertex[here[i]] = again ? vertex[here[i - 1]] : here[i];
    }
  });
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

/// A side of a triangle among those that leave one vertex for a later one.
struct HalfEdge {
  std::uint32_t other;   // the later vertex
  std::uint32_t number;  // 3 · triangle + corner

  auto operator<=>(const HalfEdge&) const = default;
};

}  // namespace

EdgeGraph build_edge_graph(const MeshView& mesh, double weld) {
  PENUMBRA_ASSERT(mesh.triangles.size() <= kMostTriangles, "{} triangles", mesh.triangles.size());
  PENUMBRA_ASSERT(weld >= 0 && std::isfinite(weld), "weld {}", weld);
  EdgeGraph graph;
  graph.vertex = merge_equal(mesh.positions);
  if (weld > 0) join_close(mesh.positions, weld, graph.vertex);

  const std::size_t triangle_count = mesh.triangles.size();
  graph.kind.resize(triangle_count);
  for_each_index(triangle_count,
                 [&](std::size_t t) { graph.kind[t] = kind_of(mesh.positions, graph.corners(mesh.triangles[t])); });

  // Sides by their first vertex; a bucket more for those of triangles that repeat a vertex, which are no edges.
  const auto ends = [&](std::size_t side) {
    const Triangle corners = graph.corners(mesh.triangles[side / 3]);
    return std::minmax({corners[side % 3], corners[(side % 3 + 1) % 3]});
  };
  const std::size_t vertices = mesh.positions.size();
  Buckets sides = into_buckets(3 * triangle_count, vertices + 1, [&](std::size_t side) {
    return graph.kind[side / 3] == TriangleKind::repeated ? vertices : std::size_t{ends(side).first};
  });
  // Within a bucket by the second vertex, then by number; `begun` counts the edges that begin at each vertex.
  std::vector<HalfEdge> half_edges(sides.first[vertices]);
  std::vector<std::uint32_t> begun(vertices + 1, 0);
  for_each_index(vertices, [&](std::size_t vertex) {
    const std::span<HalfEdge> here = std::span(half_edges).subspan(sides.first[vertex], sides[vertex].size());
    std::ranges::transform(sides[vertex], here.begin(), [&](std::uint32_t side) {
      return HalfEdge{ends(side).second, side};
    });
    std::ranges::sort(here);
    for (std::size_t i = 0; i < here.size(); ++i) begun[vertex] += i == 0 || here[i].other != here[i - 1].other ? 1 : 0;
  });
  std::uint32_t edges = 0;
  for (std::uint32_t& number : begun) edges += std::exchange(number, edges);

  graph.edges.resize(edges);
  graph.first.assign(edges + std::size_t{1}, static_cast<std::uint32_t>(half_edges.size()));
  graph.incidences.resize(half_edges.size());
  graph.triangle_edges.assign(triangle_count, {EdgeGraph::kNoEdge, EdgeGraph::kNoEdge, EdgeGraph::kNoEdge});
  for_each_index(vertices, [&](std::size_t vertex) {
    std::uint32_t next = begun[vertex];
    for (std::uint32_t i = sides.first[vertex]; i < sides.first[vertex + 1]; ++i) {
      const auto& [other, number] = half_edges[i];
      if (i == sides.first[vertex] || other != half_edges[i - 1].other) {
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
