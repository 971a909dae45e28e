// SPDX-License-Identifier: Apache-2.0
// Computes silhouettes as seen from the light's centre, and the side of each on which its shadow ends. Wyman and Hansen
// 2003 and Chan and Durand 2003 draw whole cones and corners at a silhouette's vertices; here each end has only the
// part outside of its own edge: the inner part would shade the caster's own lit side.

#include "maps/single_shadow/outer_edges.hpp"

#include "maps/products/light_shape.hpp"
#include "maps/products/slices.hpp"
#include "mesh/edge_graph.hpp"
#include "mesh/silhouettes.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace penumbra::maps {
namespace {

glm::dvec2 seen(const glm::dvec3& p) {
  return glm::dvec2(p) / p.z;
}

/// Clips an edge to the part at least `near` in front of the plane z = 0; returns false if nothing is left.
bool keep_in_front(glm::dvec3& a, glm::dvec3& b, double near) {
  if (a.z < near && b.z < near) return false;
  const auto cut = [&](glm::dvec3& end, const glm::dvec3& other) {
    if (end.z >= near) return;
    end = glm::mix(end, other, (near - end.z) / (other.z - end.z));
    end.z = near;
  };
  cut(a, b);
  cut(b, a);
  return true;
}

/// Returns the edge with the direction of its outer part; nullopt if the edge is seen as a point. `left`: the outer
/// side is to the left of the direction from a to b, with x to the right and y up.
std::optional<gpu::OuterEdge> outer_edge(const glm::dvec3& a, const glm::dvec3& b, bool left, OuterForm form,
                                         double radius) {
  const glm::dvec2 direction = seen(b) - seen(a);
  const double length = glm::length(direction);
  if (!(length > 0)) return std::nullopt;
  const glm::dvec2 along = direction / length;
  const glm::dvec2 beside = left ? glm::dvec2(-along.y, along.x) : glm::dvec2(along.y, -along.x);
  glm::dvec2 outward = beside;
  if (form == OuterForm::cones) {
    // Direction of the line that touches both circles: wherever both cones are cut, their radii differ by the same
    // amount.
    const double lean = std::clamp(radius * (1 / a.z - 1 / b.z) / length, -1.0, 1.0);
    outward = lean * along + std::sqrt(1 - lean * lean) * beside;
  }
  return gpu::OuterEdge{glm::vec3(a), glm::vec3(b), glm::vec2(outward), glm::vec2(along)};
}

}  // namespace

OuterEdges outer_edges(const visibility::SceneFloats& scene, const visibility::Light& light, const LightBasis& basis,
                       OuterForm form, double near) {
  std::vector<visibility::Triangle> casters;
  std::vector<std::uint8_t> is_ground;
  const std::uint32_t ground = ground_of(scene, light, basis);
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (scene.casts_shadow[i] == 0 || scene.emits[i] == light.index) continue;
    casters.push_back(scene.triangles[i]);
    is_ground.push_back(scene.object[i] == ground ? 1 : 0);
  }
  const std::vector<glm::dvec3> positions = mesh::widened(scene.positions);
  const mesh::MeshView mesh{positions, casters};
  const mesh::EdgeGraph graph = mesh::build_edge_graph(mesh);
  const double radius = half_width(light);
  OuterEdges edges;
  double lengths = 0, heights = 0;
  for (const mesh::SilhouetteEdge& silhouette : mesh::silhouette_edges(mesh, graph, basis.center)) {
    const mesh::Edge& edge = graph.edges[silhouette.edge];
    for (std::size_t side = 0; side < 2; ++side) {
      glm::dvec3 a = basis.local(positions[edge.a]), b = basis.local(positions[edge.b]);
      if (side == 1) {
        a.z = -a.z;
        b.z = -b.z;
      }
      if (!keep_in_front(a, b, near)) continue;
      // Triangles that run from a to b counter-clockwise as seen from the centre are to the left of the edge there.
      // This is the right side here, where x × y points away from the centre; behind the light, where z is mirrored, it
      // is the left side.
      const bool left = (silhouette.multiplicity > 0) == (side == 0);
      const auto outer = outer_edge(a, b, left, form, radius);
      if (!outer) continue;
      edges.sides[side].push_back(*outer);
      const auto around = graph.around(silhouette.edge);
      if (std::ranges::all_of(around, [&](const auto& incidence) { return is_ground[incidence.triangle] != 0; }))
        continue;
      const double length = glm::length(seen(b) - seen(a));
      lengths += length;
      heights += length * 0.5 * (a.z + b.z);
    }
  }
  edges.mean_height = lengths > 0 ? heights / lengths : 0;
  return edges;
}

}  // namespace penumbra::maps
