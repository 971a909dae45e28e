#pragma once

#include "mesh/edge_graph.hpp"
#include "mesh/predicates.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

/// The manifold, orientable parts of a soup as a half-edge structure (OpenMesh), for code that walks on surfaces:
/// loops, components. Faces that such a structure cannot hold are listed, each with its reason, and stay on the soup
/// path: nothing that decides about shadows may look at this view alone.
namespace penumbra::mesh {

/// Why a triangle is not held.
enum class NotHeld : std::uint8_t {
  repeated_vertex,  ///< two corners at one point
  collinear,        ///< no area
  crowded_edge,     ///< one of its edges has more than two triangles with an area
  not_orientable,   ///< its neighbours that are held want it wound both ways (it closes a Möbius band)
  refused,          ///< OpenMesh would not take it; not known to happen
};

struct ListedFace {
  std::uint32_t triangle = 0;
  NotHeld why = NotHeld::refused;

  friend bool operator==(const ListedFace&, const ListedFace&) = default;
};

/// Faces that hang together through edges.
struct SurfaceComponent {
  std::uint32_t faces = 0;
  std::uint32_t first_face = 0;  ///< the lowest
  bool closed = false;           ///< no boundary
};

/// A closed walk along edges of one component: edges[i] leads from vertices[i] to vertices[i + 1] (and round again),
/// with the faces that the loop encloses on its left, as seen from where they run counter-clockwise.
struct SurfaceLoop {
  std::vector<std::uint32_t> vertices;  ///< of the view
  std::vector<std::uint32_t> edges;     ///< of the edge graph
  std::uint32_t component = 0;
};

/// A view's faces are consecutive numbers in the order of the soup's triangles. Its vertices are one for each fan of
/// faces: a point where several fans meet is as many vertices here. Held and listed faces together are the soup's
/// triangles, each once (asserted). Within a component all faces are wound alike; those that had to be turned for it
/// are the fewer (at a tie, those that disagree with the component's first face). A function of the soup alone.
/// Movable.
class HalfEdgeView {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  HalfEdgeView(const MeshView& mesh, const EdgeGraph& graph);  // which need not outlive it
  HalfEdgeView(HalfEdgeView&&) noexcept;
  HalfEdgeView& operator=(HalfEdgeView&&) noexcept;
  ~HalfEdgeView();

  [[nodiscard]] std::span<const std::uint32_t> triangle_of_face() const;  ///< the soup's, ascending
  [[nodiscard]] std::span<const std::uint32_t> face_of_triangle() const;  ///< kNone: listed
  [[nodiscard]] std::span<const std::uint32_t> point_of_vertex() const;   ///< the edge graph's vertex
  [[nodiscard]] std::span<const ListedFace> listed() const;               ///< ascending
  [[nodiscard]] std::span<const std::uint32_t> turned() const;            ///< the soup's triangles, ascending
  [[nodiscard]] std::span<const SurfaceComponent> components() const;     ///< by their first face
  [[nodiscard]] std::span<const std::uint32_t> component_of_face() const;

  /// A face's corners: vertices of the view, as the face is wound here.
  [[nodiscard]] Triangle corners(std::uint32_t face) const;

  /// The loops around a set of faces: each edge between a face inside and one that is not (or none) is in one loop,
  /// once for each inside face. Where several sectors of the set meet in a vertex, a loop follows its own sector.
  [[nodiscard]] std::vector<SurfaceLoop> loops_around(const std::vector<bool>& inside) const;

  /// The loops around the faces that a point p sees from the given side, `facings` being mesh::facings(…, p) of the
  /// whole soup. Tie rule: a face seen edge-on belongs to neither side, so in the loops around the front it counts as
  /// back. Over the held faces, k_e(p) is exactly the number of front loops that run through the edge from a to b less
  /// those from b to a, less the same of the back loops, ties or not. In a closed component without a tie, the front
  /// loops alone are the silhouette. Every loop is closed, of open components too, since the rim counts as the end of
  /// either side.
  [[nodiscard]] std::vector<SurfaceLoop> silhouette_loops(std::span<const Side> facings, Side side = Side::front) const;

 private:
  struct Surface;
  std::unique_ptr<Surface> surface_;
};

}  // namespace penumbra::mesh
