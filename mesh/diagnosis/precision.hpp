#pragma once

#include "mesh/diagnosis/diagnosis.hpp"
#include "mesh/edge_graph.hpp"

namespace penumbra::mesh {

/// lower and upper; then largest_coordinate, float_spacing, shortest_edge, vertices_lost and triangles_lost, which
/// follow from them.
void diagnose_precision(const MeshView& mesh, const EdgeGraph& graph, Diagnosis& diagnosis);

/// Half way between the bounds, as a scene's origin is: scene floats are float32 of (position − this).
glm::dvec3 centre_of_bounds(const Diagnosis& diagnosis);

}  // namespace penumbra::mesh
