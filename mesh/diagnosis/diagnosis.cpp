// SPDX-License-Identifier: Apache-2.0
// Runs the searches for defects of a mesh and joins their results.

#include "mesh/diagnosis/diagnosis.hpp"

#include "mesh/diagnosis/defect_list.hpp"
#include "mesh/diagnosis/mesh_topology.hpp"
#include "mesh/diagnosis/precision.hpp"
#include "mesh/diagnosis/progress.hpp"
#include "mesh/diagnosis/self_intersections.hpp"
#include "mesh/diagnosis/t_junctions.hpp"
#include "mesh/diagnosis/winding.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra::mesh {
namespace {

using Corners = std::array<glm::dvec3, 3>;

Corners corners_in_space(const MeshView& mesh, const EdgeGraph& graph, std::uint32_t t) {
  const Triangle corners = graph.corners(mesh.triangles[t]);
  return {mesh.positions[corners[0]], mesh.positions[corners[1]], mesh.positions[corners[2]]};
}

/// Returns whether the lowest altitude (2 area / longest edge) is below kNeedle times the longest edge. Computed in
/// units of the largest coordinate difference, so that no relevant value over- or underflows.
bool is_needle(const Corners& p) {
  glm::dvec3 u = 0.5 * p[1] - 0.5 * p[0], v = 0.5 * p[2] - 0.5 * p[0];
  const glm::dvec3 largest = glm::max(glm::abs(u), glm::abs(v));
  const double size = std::max({largest.x, largest.y, largest.z});
  u /= size;
  v /= size;
  const double longest = std::max({glm::dot(u, u), glm::dot(v, v), glm::dot(v - u, v - u)});
  return glm::length(glm::cross(u, v)) < kNeedle * longest;
}

/// Finds zero_area_triangles and needles.
void diagnose_shapes(const MeshView& mesh, const EdgeGraph& graph, std::size_t list_limit, Diagnosis& diagnosis) {
  DefectList zero_area(list_limit), needles(list_limit);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle corners = graph.corners(mesh.triangles[t]);
    if (graph.kind[t] != TriangleKind::proper) {
      zero_area.add(std::array{t}, corners);
    } else if (is_needle(corners_in_space(mesh, graph, t))) {
      needles.add(std::array{t}, corners);
    }
  }
  diagnosis.zero_area_triangles = std::move(zero_area).finish(mesh);
  diagnosis.needles = std::move(needles).finish(mesh);
}

/// Returns the volume, summed in the order of the triangles, so that the result is reproducible.
double signed_volume(const MeshView& mesh, const EdgeGraph& graph, const glm::dvec3& centre) {
  double six_times = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (graph.kind[t] != TriangleKind::proper) continue;
    const Corners p = corners_in_space(mesh, graph, t);
    six_times += glm::dot(p[0] - centre, glm::cross(p[1] - centre, p[2] - centre));
  }
  return six_times / 6;
}

}  // namespace

Diagnosis diagnose(const MeshView& mesh, const DiagnosisOptions& options) {
  const auto report = [&](double share) {
    if (options.progress) options.progress(share);
  };
  const std::size_t limit = options.list_limit;
  const double searched = options.search_intersections ? 0.4 : 1;  // the fraction of the progress before the search
  Diagnosis diagnosis;
  diagnosis.triangles = mesh.triangles.size();
  const EdgeGraph graph = build_edge_graph(mesh, options.weld);
  report(0.3 * searched);

  diagnosis.vertices = count_vertices(mesh, graph);
  diagnosis.components = count_components(graph);
  diagnose_edges(mesh, graph, limit, diagnosis);
  diagnose_duplicates(mesh, graph, limit, diagnosis);
  {
    const Fans fans = find_fans(mesh, graph);
    diagnosis.boundary_loops = count_boundary_loops(graph, fans);
    diagnosis.non_manifold_vertices = non_manifold_vertices(mesh, graph, fans, limit);
  }
  report(0.5 * searched);

  diagnosis.closed_as_wound = is_closed(mesh, graph);
  diagnosis.closed = is_closed(mesh, graph, turns_to_agree(mesh, graph));
  diagnose_shapes(mesh, graph, limit, diagnosis);
  diagnose_precision(mesh, graph, diagnosis);
  diagnosis.volume = signed_volume(mesh, graph, centre_of_bounds(diagnosis));
  report(0.6 * searched);

  diagnosis.t_junctions = find_t_junctions(mesh, graph, limit, {options.progress, 0.6 * searched, searched});
  if (options.search_intersections) {
    diagnosis.self_intersections = find_self_intersections(mesh, graph, limit, {options.progress, searched, 1});
  }
  report(1);
  return diagnosis;
}

}  // namespace penumbra::mesh
