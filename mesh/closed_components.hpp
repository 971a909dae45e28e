#pragma once

#include "mesh/edge_graph.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::mesh {

/// Triangles that are connected through edges.
struct Component {
  std::vector<std::uint32_t> triangles;  ///< the first has the smallest number
  bool closed = true;  ///< exactly two triangles at every edge, all of them with an area and windable alike
};

/// All components of a mesh, in the order of their first triangles, and how to wind them.
struct Components {
  std::vector<Component> components;
  /// ±1 for each triangle: as stored, or the other way round, so that neighbours in a closed component run against one
  /// another along their edge. The first triangle of each keeps its winding. Of no meaning in components that are open.
  std::vector<std::int8_t> turn;
};

/// Linear in the mesh. Windings in the file need not agree.
Components find_components(const MeshView& mesh, const EdgeGraph& graph);

/// Six times the volume that a closed component encloses, wound by `turn`: positive if its normals point outward. In
/// double, relative to one of its own vertices, so that a mesh far from the origin comes out no worse.
double signed_volume(const MeshView& mesh, const Component& component, const std::vector<std::int8_t>& turn);

}  // namespace penumbra::mesh
