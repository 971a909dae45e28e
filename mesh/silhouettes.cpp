// SPDX-License-Identifier: Apache-2.0
// Computes signed multiplicities of edges seen from a point (Bergeron 1986; Laine et al. 2005; Lehtinen et al. 2006),
// extended to any triangle soup (silhouettes.hpp has the definition), with exact signs.

#include "mesh/silhouettes.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace penumbra::mesh {
namespace {

/// Returns the side that every point of the hull sees a triangle from; nullopt if the sides differ.
std::optional<Side> common_side(const MeshView& mesh, const Triangle& t, std::span<const glm::dvec3> corners) {
  const auto side = [&](const glm::dvec3& p) {
    return side_of_plane(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], p);
  };
  const Side first = side(corners.front());
  for (const glm::dvec3& corner : corners.subspan(1)) {
    if (side(corner) != first) return std::nullopt;
  }
  return first;
}

/// Returns whether (a, b, c) and (a, b, d) lie on one plane, with c and d on opposite sides of their edge: then their
/// contributions cancel for every p. `off_plane` is any point that is not on the plane.
bool always_cancel(const MeshView& mesh, const Edge& edge, std::uint32_t c, std::uint32_t d,
                   std::span<const glm::dvec3> corners) {
  const glm::dvec3 &a = mesh.positions[edge.a], &b = mesh.positions[edge.b];
  const glm::dvec3 &at_c = mesh.positions[c], &at_d = mesh.positions[d];
  if (side_of_plane(a, b, at_c, at_d) != Side::on) return false;
  const auto off_plane =
      std::ranges::find_if(corners, [&](const auto& p) { return side_of_plane(a, b, at_c, p) != Side::on; });
  if (off_plane == corners.end()) return true;  // the hull lies in the plane, and both contributions are 0 on all of it
  return side_of_plane(a, b, at_c, *off_plane) == opposite(side_of_plane(a, b, at_d, *off_plane));
}

bool certainly_zero(const MeshView& mesh, const EdgeGraph& graph, std::uint32_t edge,
                    std::span<const std::optional<Side>> sides, std::span<const glm::dvec3> corners) {
  int sum = 0;
  std::vector<std::uint32_t> mixed;  // apexes of the triangles that the hull sees from both sides
  for (const Incidence& incidence : graph.around(edge)) {
    const std::optional<Side> side = sides[incidence.triangle];
    if (!side) {
      mixed.push_back(incidence.apex);
    } else {
      sum += incidence.reversed ? -static_cast<int>(*side) : static_cast<int>(*side);
    }
  }
  while (!mixed.empty()) {
    const std::uint32_t apex = mixed.back();
    mixed.pop_back();
    const auto partner = std::ranges::find_if(
        mixed, [&](std::uint32_t other) { return always_cancel(mesh, graph.edges[edge], apex, other, corners); });
    if (partner == mixed.end()) return false;
    mixed.erase(partner);
  }
  return sum == 0;
}

}  // namespace

std::vector<Side> facings(const MeshView& mesh, const EdgeGraph& graph, const glm::dvec3& p) {
  std::vector<Side> sides(mesh.triangles.size(), Side::on);
  for_each_index(sides.size(), [&](std::size_t i) {
    if (graph.kind[i] != TriangleKind::proper) return;
    const Triangle t = graph.corners(mesh.triangles[i]);
    sides[i] = side_of_plane(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], p);
  });
  return sides;
}

int signed_multiplicity(const EdgeGraph& graph, std::uint32_t edge, std::span<const Side> facings) {
  int sum = 0;
  for (const Incidence& incidence : graph.around(edge)) {
    const int side = static_cast<int>(facings[incidence.triangle]);
    sum += incidence.reversed ? -side : side;
  }
  return sum;
}

std::vector<SilhouetteEdge> silhouette_edges(const MeshView& mesh, const EdgeGraph& graph, const glm::dvec3& p) {
  const std::vector<Side> sides = facings(mesh, graph, p);
  std::vector<SilhouetteEdge> silhouettes;
  for (std::uint32_t edge = 0; edge < graph.edges.size(); ++edge) {
    const int multiplicity = signed_multiplicity(graph, edge, sides);
    if (multiplicity != 0) silhouettes.push_back({edge, multiplicity});
  }
  return silhouettes;
}

std::vector<std::uint32_t> possible_silhouette_edges(const MeshView& mesh, const EdgeGraph& graph,
                                                     std::span<const glm::dvec3> corners) {
  PENUMBRA_ASSERT(!corners.empty(), "a hull needs a point");
  std::vector<std::optional<Side>> sides(mesh.triangles.size(), Side::on);
  for_each_index(sides.size(), [&](std::size_t i) {
    if (graph.kind[i] != TriangleKind::proper) return;
    sides[i] = common_side(mesh, graph.corners(mesh.triangles[i]), corners);
  });
  std::vector<std::uint8_t> possible(graph.edges.size());
  for_each_index(possible.size(), [&](std::size_t edge) {
    possible[edge] = !certainly_zero(mesh, graph, static_cast<std::uint32_t>(edge), sides, corners);
  });
  std::vector<std::uint32_t> edges;
  for (std::uint32_t edge = 0; edge < possible.size(); ++edge) {
    if (possible[edge] != 0) edges.push_back(edge);
  }
  return edges;
}

}  // namespace penumbra::mesh
