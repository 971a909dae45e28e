// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/diagnosis/diagnosis.hpp"
#include "mesh/edge_graph.hpp"

#include <cstdint>
#include <vector>

/// Connectivity of a triangle soup: everything here follows from the edge graph, without coordinates.
namespace penumbra::mesh {

/// The fans of every vertex: its triangles, linked where they share an edge that ends there. All triangles of such an
/// edge belong to one fan, however many there are.
struct Fans {
  static constexpr std::uint32_t kNone = 0xffffffffu;

  std::vector<std::uint32_t> fan;    ///< fan of corner i of triangle t, at [3 t + i]; kNone where t repeats a vertex
  std::vector<std::uint32_t> count;  ///< number of fans of each vertex
};
Fans find_fans(const MeshView& mesh, const EdgeGraph& graph);

std::uint64_t count_vertices(const MeshView& mesh, const EdgeGraph& graph);
std::uint64_t count_components(const EdgeGraph& graph);
std::uint64_t count_boundary_loops(const EdgeGraph& graph, const Fans& fans);

/// Finds boundary_edges, non_manifold_edges and inconsistent_windings.
void diagnose_edges(const MeshView& mesh, const EdgeGraph& graph, std::size_t list_limit, Diagnosis& diagnosis);
/// Finds duplicate_faces and opposite_faces.
void diagnose_duplicates(const MeshView& mesh, const EdgeGraph& graph, std::size_t list_limit, Diagnosis& diagnosis);
Defect non_manifold_vertices(const MeshView& mesh, const EdgeGraph& graph, const Fans& fans, std::size_t list_limit);

}  // namespace penumbra::mesh
