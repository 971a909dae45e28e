// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/diagnosis/diagnosis.hpp"
#include "mesh/edge_graph.hpp"
#include "mesh/diagnosis/progress.hpp"

namespace penumbra::mesh {

/// Finds every pair of triangles with an area that meet elsewhere than in a vertex or edge that they share: exact, on
/// all cores. This includes triangles with the same three vertices, and neighbours that fold onto one another. Costs a
/// test for each pair of overlapping boxes, where triangles with the same three vertices count as one: about n log n
/// for a surface, however often it is repeated, and n² for different triangles that are all as large as the whole mesh.
/// The points of a listed place are the first triangle's corners, then the second's.
Defect find_self_intersections(const MeshView& mesh, const EdgeGraph& graph, std::size_t list_limit,
                               const Progress& progress);

}  // namespace penumbra::mesh
