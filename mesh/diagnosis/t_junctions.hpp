// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/diagnosis/diagnosis.hpp"
#include "mesh/edge_graph.hpp"
#include "mesh/diagnosis/progress.hpp"

namespace penumbra::mesh {

/// Finds every pair of a vertex (a corner of any triangle) and an edge whose interior contains it exactly. In
/// DefectPlace, the points of a listed place are the vertex and the edge's two ends; its triangles are those of the
/// edge.
Defect find_t_junctions(const MeshView& mesh, const EdgeGraph& graph, std::size_t list_limit, const Progress& progress);

}  // namespace penumbra::mesh
