// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/edge_graph.hpp"
#include "mesh/predicates.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

/// The manifold, orientable parts of a soup as a half-edge structure (OpenMesh), for code that walks on surfaces:
/// loops, components. Faces that such a structure cannot hold are listed, each with its reason, and remain in the soup
/// only: code that decides about shadows must not use this view alone.
namespace penumbra::mesh {

/// Reason why a triangle is not held.
enum class NotHeld : std::uint8_t {
  repeated_vertex,  ///< two corners at one point
  collinear,        ///< no area
  crowded_edge,     ///< one of its edges has more than two triangles with an area
  not_orientable,   ///< its held neighbours require contradictory windings (it closes a Möbius band)
  refused,          ///< refused by OpenMesh; not known to happen
};

struct ListedFace {
  std::uint32_t triangle = 0;
  NotHeld why = NotHeld::refused;

  friend bool operator==(const ListedFace&, const ListedFace&) = default;
};

/// Faces that are connected through edges.
struct SurfaceComponent {
  std::uint32_t faces = 0;
  std::uint32_t first_face = 0;  ///< the lowest index
  bool closed = false;           ///< no boundary
};

/// A closed walk along edges of one component: edges[i] leads from vertices[i] to vertices[i + 1] (cyclically), with
/// the enclosed faces on its left, as seen from the side on which they run counter-clockwise.
struct SurfaceLoop {
  std::vector<std::uint32_t> vertices;  ///< vertices of the view
  std::vector<std::uint32_t> edges;     ///< edges of the edge graph
  std::uint32_t component = 0;
};

/// Faces of a view are consecutive numbers in the order of the soup's triangles. A view has one vertex for each fan of
/// faces: a point where several fans meet is several vertices here. Held and listed faces together are the soup's
/// triangles, each once (asserted). Within a component all faces have consistent windings; the faces that had to be
/// turned for it are the minority (at a tie, those that disagree with the component's first face). A function of the
/// soup alone. Movable.
class HalfEdgeView {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  HalfEdgeView(const MeshView& mesh, const EdgeGraph& graph);  // the arguments need not outlive the view
  HalfEdgeView(HalfEdgeView&&) noexcept;
  HalfEdgeView& operator=(HalfEdgeView&&) noexcept;
  ~HalfEdgeView();

  [[nodiscard]] std::span<const std::uint32_t> triangle_of_face() const;  ///< indices into the soup, ascending
  [[nodiscard]] std::span<const std::uint32_t> face_of_triangle() const;  ///< kNone for listed triangles
  [[nodiscard]] std::span<const std::uint32_t> point_of_vertex() const;   ///< vertices of the edge graph
  [[nodiscard]] std::span<const ListedFace> listed() const;               ///< ascending
  [[nodiscard]] std::span<const std::uint32_t> turned() const;            ///< indices into the soup, ascending
  [[nodiscard]] std::span<const SurfaceComponent> components() const;     ///< in the order of their first faces
  [[nodiscard]] std::span<const std::uint32_t> component_of_face() const;

  /// Returns a face's corners: vertices of the view, in the winding of the view.
  [[nodiscard]] Triangle corners(std::uint32_t face) const;

  /// Returns the loops around a set of faces: each edge between a face inside and one outside (or none) is in one loop,
  /// once for each inside face. Where several sectors of the set meet in a vertex, a loop follows its own sector.
  [[nodiscard]] std::vector<SurfaceLoop> loops_around(const std::vector<bool>& inside) const;

  /// Returns the loops around the faces that a point p sees from the given side; `facings` is mesh::facings(…, p) of
  /// the whole soup. Tie rule: a face seen edge-on belongs to neither side, so in the loops around the front faces it
  /// counts as back. Over the held faces, k_e(p) of silhouettes.hpp is exactly the number of front loops that run
  /// through the edge from a to b less those from b to a, less the same difference of the back loops, with or without
  /// ties. In a closed component without a tie, the front loops alone are the silhouette. Every loop is closed, also in
  /// open components, since the boundary counts as the end of either side.
  [[nodiscard]] std::vector<SurfaceLoop> silhouette_loops(std::span<const Side> facings, Side side = Side::front) const;

 private:
  struct Surface;
  std::unique_ptr<Surface> surface_;
};

}  // namespace penumbra::mesh
