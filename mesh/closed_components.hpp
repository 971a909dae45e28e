// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/edge_graph.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::mesh {

/// Triangles that are connected through edges.
struct Component {
  std::vector<std::uint32_t> triangles;  ///< the first has the smallest index
  bool closed = true;  ///< exactly two triangles at every edge, all with non-zero area, and consistently orientable
};

/// All components of a mesh, in the order of their first triangles, and a consistent winding.
struct Components {
  std::vector<Component> components;
  /// For each triangle 1 (winding as stored) or −1 (reversed), so that neighbours in a closed component traverse their
  /// common edge in opposite directions. The first triangle of each component keeps its winding. Meaningless in open
  /// components.
  std::vector<std::int8_t> turn;
};

/// Finds the components, in time linear in the mesh. Windings in the file need not agree.
Components find_components(const MeshView& mesh, const EdgeGraph& graph);

/// Returns six times the volume that a closed component encloses, wound by `turn`: positive if its normals point
/// outward. In double, relative to one of the component's own vertices, so that precision does not depend on the
/// distance from the origin.
double signed_volume(const MeshView& mesh, const Component& component, const std::vector<std::int8_t>& turn);

}  // namespace penumbra::mesh
