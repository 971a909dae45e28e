// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/diagnosis/diagnosis.hpp"
#include "mesh/edge_graph.hpp"

namespace penumbra::mesh {

/// Computes lower and upper; then largest_coordinate, float_spacing, shortest_edge, vertices_lost and triangles_lost,
/// which follow from the bounds.
void diagnose_precision(const MeshView& mesh, const EdgeGraph& graph, Diagnosis& diagnosis);

/// Returns the centre of the bounds, computed as a scene's origin is: scene floats are float32 of (position − centre).
glm::dvec3 centre_of_bounds(const Diagnosis& diagnosis);

}  // namespace penumbra::mesh
