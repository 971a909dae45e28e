// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::mesh {

/// The triangles of a soup, borrowed. Positions must be finite, indices in range.
struct MeshView {
  std::span<const glm::dvec3> positions;
  std::span<const Triangle> triangles;
};

enum class TriangleKind : std::uint8_t {
  proper,     ///< has an area
  collinear,  ///< three different vertices on a line (decided exactly): no area
  repeated,   ///< two corners are the same vertex: no area, and no edges in the graph
};

/// One of the triangles at an edge.
struct Incidence {
  std::uint32_t triangle = 0;
  std::uint32_t apex = 0;  ///< the triangle's third vertex
  bool reversed = false;   ///< the triangle's winding runs from the edge's b to its a

  friend bool operator==(const Incidence&, const Incidence&) = default;
};

/// An edge's two end points: vertex numbers, a < b.
struct Edge {
  std::uint32_t a = 0, b = 0;

  friend auto operator<=>(const Edge&, const Edge&) = default;
};

/// Each geometric edge once, with all its triangles: none, one, two, five are all legal. Linear in the soup.
///
/// A *vertex* is a point in space, named by the first position that lies there: positions with equal coordinates (−0 =
/// +0) are one vertex however often a file repeats them. Edges are sorted by (a, b), the triangles of an edge by index:
/// the graph is a function of the soup alone, and does not depend on the number of threads.
struct EdgeGraph {
  static constexpr std::uint32_t kNoEdge = 0xffffffffu;

  std::vector<std::uint32_t> vertex;         ///< for each position: its vertex, the first position at its place
  std::vector<TriangleKind> kind;            ///< for each triangle
  std::vector<Edge> edges;                   ///< edges of all triangles that do not repeat a vertex
  std::vector<std::uint32_t> first;          ///< edges.size() + 1 offsets into `incidences`
  std::vector<Incidence> incidences;         ///< grouped by edge; proper and collinear triangles
  std::vector<std::array<std::uint32_t, 3>>  ///< for each triangle, the edge from corner i to corner i + 1;
      triangle_edges;                        ///< kNoEdge where the triangle repeats a vertex

  [[nodiscard]] std::span<const Incidence> around(std::uint32_t edge) const {
    return std::span(incidences).subspan(first[edge], first[edge + 1] - first[edge]);
  }
  /// Returns a triangle's corners as vertices.
  [[nodiscard]] Triangle corners(const Triangle& triangle) const {
    return {vertex[triangle[0]], vertex[triangle[1]], vertex[triangle[2]]};
  }
};

/// Builds the edge graph. `weld` > 0 (in the scene's unit) also merges positions at most that far apart, and chains of
/// such positions; the vertex lies where the first of them does. In parallel, in time and memory linear in the soup
/// (with `weld`: O(n log n)).
EdgeGraph build_edge_graph(const MeshView& mesh, double weld = 0);

/// Returns float coordinates converted to double, so that build_edge_graph can take float meshes (SceneFloats).
std::vector<glm::dvec3> widened(std::span<const glm::vec3> positions);

}  // namespace penumbra::mesh
