#include "mesh/edge_graph.hpp"

#include "base/assert.hpp"
#include "base/buckets.hpp"
#include "base/parallel.hpp"
#include "mesh/predicates.hpp"
#include "mesh/union_find.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
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

/// A side of a triangle among those that leave one vertex for a later one: that vertex, then 3 · triangle + corner. In
/// this order.
using HalfEdge = std::uint64_t;
std::uint32_t later_vertex(HalfEdge side) {
  return static_cast<std::uint32_t>(side >> 32U);
}
std::uint32_t number_of(HalfEdge side) {
  return static_cast<std::uint32_t>(side);
}

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

  // Sides by their first vertex, but for those of triangles that repeat a vertex, which are no edges: `sides` of each
  // vertex from `first_side` on.
  const std::size_t vertices = mesh.positions.size();
  std::vector<std::uint32_t> first_side(vertices + 1, 0);
  const auto counter = [&](std::size_t vertex) { return std::atomic_ref(first_side[vertex]); };
  const auto for_each_side = [&](const auto& visit) {
    for_each_index(triangle_count, [&](std::size_t t) {
      if (graph.kind[t] == TriangleKind::repeated) return;
      const Triangle corners = graph.corners(mesh.triangles[t]);
      for (std::uint32_t i = 0; i < 3; ++i) {
        const auto [a, b] = std::minmax(corners[i], corners[(i + 1) % 3]);
        visit(a, HalfEdge{b} << 32U | (3 * static_cast<std::uint32_t>(t) + i));
      }
    });
  };
  for_each_side([&](std::uint32_t a, HalfEdge) { counter(a).fetch_add(1, std::memory_order_relaxed); });
  std::uint32_t all_sides = 0;
  for (std::uint32_t& first : first_side) first = all_sides += first;  // where they end
  std::vector<HalfEdge> half_edges(all_sides);
  for_each_side([&](std::uint32_t a, HalfEdge side) {
    half_edges[counter(a).fetch_sub(1, std::memory_order_relaxed) - 1] = side;
  });
  // Sorted, whatever the number of threads; `begun` counts the edges that begin at each vertex.
  std::vector<std::uint32_t> begun(vertices + 1, 0);
  for_each_index(vertices, [&](std::size_t vertex) {
    const std::span here =
        std::span(half_edges).subspan(first_side[vertex], first_side[vertex + 1] - first_side[vertex]);
    std::ranges::sort(here);
    for (std::size_t i = 0; i < here.size(); ++i)
      begun[vertex] += i == 0 || later_vertex(here[i]) != later_vertex(here[i - 1]) ? 1 : 0;
  });
  std::uint32_t edges = 0;
  for (std::uint32_t& number : begun) edges += std::exchange(number, edges);

  graph.edges.resize(edges);
  graph.first.assign(edges + std::size_t{1}, static_cast<std::uint32_t>(half_edges.size()));
  graph.incidences.resize(half_edges.size());
  graph.triangle_edges.assign(triangle_count, {EdgeGraph::kNoEdge, EdgeGraph::kNoEdge, EdgeGraph::kNoEdge});
  for_each_index(vertices, [&](std::size_t vertex) {
    std::uint32_t next = begun[vertex];
    for (std::uint32_t i = first_side[vertex]; i < first_side[vertex + 1]; ++i) {
      const std::uint32_t other = later_vertex(half_edges[i]), number = number_of(half_edges[i]);
      if (i == first_side[vertex] || other != later_vertex(half_edges[i - 1])) {
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
