// SPDX-License-Identifier: Apache-2.0
// Computes fans, components and other connectivity of a triangle soup from its edge graph. Not from a paper.

#include "mesh/diagnosis/mesh_topology.hpp"

#include "mesh/diagnosis/defect_list.hpp"
#include "mesh/disjoint_sets.hpp"

#include <algorithm>
#include <array>

namespace penumbra::mesh {
namespace {

/// Returns the indices (3 t + i) of the two corners of a triangle at the ends a and b of one of its edges.
std::array<std::uint32_t, 2> corners_at_ends(const EdgeGraph& graph, std::uint32_t edge, const Incidence& incidence) {
  const std::uint32_t t = incidence.triangle;
  std::uint32_t i = 0;
  while (graph.triangle_edges[t][i] != edge) ++i;
  const std::uint32_t begin = 3 * t + i, end = 3 * t + (i + 1) % 3;
  return incidence.reversed ? std::array{end, begin} : std::array{begin, end};
}

std::vector<std::uint32_t> triangles_of(std::span<const Incidence> incidences) {
  std::vector<std::uint32_t> triangles;
  for (const Incidence& incidence : incidences) triangles.push_back(incidence.triangle);
  return triangles;
}

}  // namespace

Fans find_fans(const MeshView& mesh, const EdgeGraph& graph) {
  DisjointSets corners(3 * mesh.triangles.size());
  for (std::uint32_t edge = 0; edge < graph.edges.size(); ++edge) {
    const auto around = graph.around(edge);
    const auto first = corners_at_ends(graph, edge, around.front());
    for (const Incidence& incidence : around.subspan(1)) {
      const auto ends = corners_at_ends(graph, edge, incidence);
      corners.join(first[0], ends[0]);
      corners.join(first[1], ends[1]);
    }
  }
  Fans fans;
  fans.fan.resize(3 * mesh.triangles.size(), Fans::kNone);
  fans.count.resize(mesh.positions.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (graph.kind[t] == TriangleKind::repeated) continue;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t corner = 3 * t + i;
      fans.fan[corner] = corners.root(corner);
      if (fans.fan[corner] == corner) ++fans.count[graph.vertex[mesh.triangles[t][i]]];
    }
  }
  return fans;
}

std::uint64_t count_vertices(const MeshView& mesh, const EdgeGraph& graph) {
  std::vector<bool> used(mesh.positions.size());
  std::uint64_t count = 0;
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : graph.corners(triangle)) {
      if (!used[vertex]) used[vertex] = true, ++count;
    }
  }
  return count;
}

std::uint64_t count_components(const EdgeGraph& graph) {
  DisjointSets triangles(graph.kind.size());
  for (std::uint32_t edge = 0; edge < graph.edges.size(); ++edge) {
    const auto around = graph.around(edge);
    for (const Incidence& incidence : around.subspan(1)) triangles.join(around.front().triangle, incidence.triangle);
  }
  std::uint64_t count = 0;
  for (std::uint32_t t = 0; t < graph.kind.size(); ++t) {
    if (graph.kind[t] != TriangleKind::repeated && triangles.root(t) == t) ++count;
  }
  return count;
}

std::uint64_t count_boundary_loops(const EdgeGraph& graph, const Fans& fans) {
  constexpr std::uint32_t kNothing = 0xffffffffu;
  std::vector<std::uint32_t> first_of_fan(fans.fan.size(), kNothing);  // for each fan, its first boundary edge
  DisjointSets edges(graph.edges.size());
  for (std::uint32_t edge = 0; edge < graph.edges.size(); ++edge) {
    if (graph.around(edge).size() != 1) continue;
    for (const std::uint32_t corner : corners_at_ends(graph, edge, graph.around(edge).front())) {
      std::uint32_t& first = first_of_fan[fans.fan[corner]];
      if (first == kNothing) first = edge;
      edges.join(first, edge);
    }
  }
  std::uint64_t loops = 0;
  for (std::uint32_t edge = 0; edge < graph.edges.size(); ++edge) {
    if (graph.around(edge).size() == 1 && edges.root(edge) == edge) ++loops;
  }
  return loops;
}

void diagnose_edges(const MeshView& mesh, const EdgeGraph& graph, std::size_t list_limit, Diagnosis& diagnosis) {
  DefectList boundary(list_limit), non_manifold(list_limit), inconsistent(list_limit);
  for (std::uint32_t edge = 0; edge < graph.edges.size(); ++edge) {
    const auto around = graph.around(edge);
    const auto [a, b] = graph.edges[edge];
    if (around.size() == 1) boundary.add({around[0].triangle}, {a, b});
    if (around.size() > 2) non_manifold.add(triangles_of(around), std::array{a, b});
    if (around.size() == 2 && around[0].reversed == around[1].reversed) {
      inconsistent.add({around[0].triangle, around[1].triangle}, {a, b});
    }
  }
  diagnosis.boundary_edges = std::move(boundary).finish(mesh);
  diagnosis.non_manifold_edges = std::move(non_manifold).finish(mesh);
  diagnosis.inconsistent_windings = std::move(inconsistent).finish(mesh);
}

void diagnose_duplicates(const MeshView& mesh, const EdgeGraph& graph, std::size_t list_limit, Diagnosis& diagnosis) {
  DefectList duplicate(list_limit), opposite(list_limit);
  std::vector<Incidence> faces;
  for (std::uint32_t edge = 0; edge < graph.edges.size(); ++edge) {
    // A face is handled at the edge of its two smaller vertices; all faces of an edge with the same apex have the same
    // vertices.
    const std::uint32_t a = graph.edges[edge].a, b = graph.edges[edge].b;
    faces.clear();
    std::ranges::copy_if(graph.around(edge), std::back_inserter(faces), [&](const auto& i) { return i.apex > b; });
    std::ranges::stable_sort(faces, {}, &Incidence::apex);
    for (auto begin = faces.begin(); begin != faces.end();) {
      const auto end = std::find_if(begin, faces.end(), [&](const auto& i) { return i.apex != begin->apex; });
      std::array<std::vector<std::uint32_t>, 2> wound;  // the triangles of each winding
      for (auto face = begin; face != end; ++face) wound[face->reversed ? 1 : 0].push_back(face->triangle);
      for (const auto& same : wound) {
        for (std::size_t i = 1; i < same.size(); ++i) duplicate.add({same[0], same[i]}, {a, b, begin->apex});
      }
      for (std::size_t i = 0; i < std::min(wound[0].size(), wound[1].size()); ++i) {
        const auto [first, second] = std::minmax(wound[0][i], wound[1][i]);
        opposite.add({first, second}, {a, b, begin->apex});
      }
      begin = end;
    }
  }
  diagnosis.duplicate_faces = std::move(duplicate).finish(mesh);
  diagnosis.opposite_faces = std::move(opposite).finish(mesh);
}

Defect non_manifold_vertices(const MeshView& mesh, const EdgeGraph& graph, const Fans& fans, std::size_t list_limit) {
  struct At {
    std::uint32_t vertex, triangle;
    auto operator<=>(const At&) const = default;
  };
  std::vector<At> all;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (graph.kind[t] == TriangleKind::repeated) continue;
    for (const std::uint32_t vertex : graph.corners(mesh.triangles[t])) {
      if (fans.count[vertex] > 1) all.push_back({vertex, t});
    }
  }
  std::ranges::sort(all);
  DefectList defects(list_limit);
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = 0; i < all.size(); ++i) {
    triangles.push_back(all[i].triangle);
    if (i + 1 < all.size() && all[i + 1].vertex == all[i].vertex) continue;
    defects.add(triangles, std::array{all[i].vertex});
    triangles.clear();
  }
  return std::move(defects).finish(mesh);
}

}  // namespace penumbra::mesh
