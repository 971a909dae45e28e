// SPDX-License-Identifier: Apache-2.0
// Finds connected components of a mesh and consistent windings by breadth-first search across edges; linear in the
// mesh. Not from a paper.

#include "mesh/closed_components.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <span>
#include <utility>

namespace penumbra::mesh {
namespace {

/// Walks from `first` across edges, giving each triangle the winding that agrees with its neighbour.
Component wind_component(const EdgeGraph& graph, std::uint32_t first, std::vector<std::int8_t>& turn) {
  Component component{{first}};
  turn[first] = 1;
  for (std::size_t i = 0; i < component.triangles.size(); ++i) {
    const std::uint32_t t = component.triangles[i];
    component.closed = component.closed && graph.kind[t] == TriangleKind::proper;
    for (const std::uint32_t edge : graph.triangle_edges[t]) {
      if (edge == EdgeGraph::kNoEdge) continue;
      const std::span<const Incidence> around = graph.around(edge);
      component.closed = component.closed && around.size() == 2;
      const auto own = std::ranges::find(around, t, &Incidence::triangle);
      for (const Incidence& other : around) {
        if (other.triangle == t) continue;
        const auto wanted = static_cast<std::int8_t>(own->reversed != other.reversed ? turn[t] : -turn[t]);
        if (turn[other.triangle] == 0) {
          turn[other.triangle] = wanted;
          component.triangles.push_back(other.triangle);
        }
        component.closed = component.closed && turn[other.triangle] == wanted;
      }
    }
  }
  return component;
}

}  // namespace

Components find_components(const MeshView& mesh, const EdgeGraph& graph) {
  Components found;
  found.turn.resize(mesh.triangles.size());
  for (std::uint32_t first = 0; first < mesh.triangles.size(); ++first) {
    if (found.turn[first] == 0) found.components.push_back(wind_component(graph, first, found.turn));
  }
  return found;
}

double signed_volume(const MeshView& mesh, const Component& component, const std::vector<std::int8_t>& turn) {
  const glm::dvec3 from = mesh.positions[mesh.triangles[component.triangles.front()][0]];
  double sum = 0;
  for (const std::uint32_t t : component.triangles) {
    const Triangle& corners = mesh.triangles[t];
    const glm::dvec3 a = mesh.positions[corners[0]] - from, b = mesh.positions[corners[1]] - from,
                     c = mesh.positions[corners[2]] - from;
    sum += turn[t] * glm::dot(a, glm::cross(b, c));
  }
  return sum;
}

}  // namespace penumbra::mesh
