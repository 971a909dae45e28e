#pragma once

#include "mesh/triangle_soup.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::mesh {

/// The triangles of a soup, borrowed. Finite positions, indices in range.
struct MeshView {
  std::span<const glm::dvec3> positions;
  std::span<const Triangle> triangles;
};

enum class TriangleKind : std::uint8_t {
  proper,     ///< has an area
  collinear,  ///< three different vertices on a line (decided exactly): no area
  repeated,   ///< two corners are the same vertex: no area, and no edges in the graph
};

/// One of the triangles around an edge.
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

/// Each geometric edge once, with all its triangles: none, one, two, five, all legal. Linear in the soup.
///
/// A *vertex* is a point in space, named by the first position that lies there: positions with equal coordinates
/// (−0 = +0) are one vertex however often a file repeats them. Edges are sorted by (a, b), the triangles of an edge by
/// number: the graph is a function of the soup alone, whatever the number of threads.
struct EdgeGraph {
  static constexpr std::uint32_t kNoEdge = 0xffffffffu;

  std::vector<std::uint32_t> vertex;         ///< for each position: its vertex, the first position at its place
  std::vector<TriangleKind> kind;            ///< for each triangle
  std::vector<Edge> edges;                   ///< of all triangles that do not repeat a vertex
  std::vector<std::uint32_t> first;          ///< edges.size() + 1 offsets into `incidences`
  std::vector<Incidence> incidences;         ///< grouped by edge; proper and collinear triangles
  std::vector<std::array<std::uint32_t, 3>>  ///< for each triangle, the edge from corner i to corner i + 1;
      triangle_edges;                        ///< kNoEdge where the triangle repeats a vertex

  [[nodiscard]] std::span<const Incidence> around(std::uint32_t edge) const {
    return std::span(incidences).subspan(first[edge], first[edge + 1] - first[edge]);
  }
  /// A triangle's corners as vertices.
  [[nodiscard]] Triangle corners(const Triangle& triangle) const {
    return {vertex[triangle[0]], vertex[triangle[1]], vertex[triangle[2]]};
  }
};

/// `weld` > 0 (the scene's unit) also makes one vertex of positions at most that far apart, and of chains of such; the
/// vertex lies where the first of them does. In parallel, in time and memory linear in the soup (`weld`: O(n log n)).
EdgeGraph build_edge_graph(const MeshView& mesh, double weld = 0);

/// Float coordinates converted to double, which the graph takes: float meshes (SceneFloats) are given to it through
/// this.
std::vector<glm::dvec3> widened(std::span<const glm::vec3> positions);

}  // namespace penumbra::mesh
