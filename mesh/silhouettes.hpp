// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/edge_graph.hpp"
#include "mesh/predicates.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

/// Silhouettes of any triangle soup. As seen from p, wind each proper triangle counter-clockwise; the *signed
/// multiplicity* k_e(p) of the edge e = (a, b) is the number of its triangles that then run a→b less those that run b→a
/// (Bergeron 1986 for open edges; Laine et al. 2005, Lehtinen et al. 2006 for closed meshes; extended here to any
/// soup). A triangle with apex c contributes the sign of (a, b, c; p), independent of its stored winding. Edges inside
/// a surface have 0, closed silhouettes ±2, open edges ±1, non-manifold edges any integer. A triangle seen edge-on (p
/// on its plane) and one without area give 0 to all their edges: this is one decision for each triangle, so the k_e of
/// the edges around a vertex always sum to zero (in − out) and sums over silhouettes stay watertight.
namespace penumbra::mesh {

/// Returns for each triangle the side that p is on: front if its winding runs counter-clockwise as seen from p; on for
/// triangles without area. Exact.
std::vector<Side> facings(const MeshView& mesh, const EdgeGraph& graph, const glm::dvec3& p);

/// Returns k_e of one edge, given every triangle's facing from p.
int signed_multiplicity(const EdgeGraph& graph, std::uint32_t edge, std::span<const Side> facings);

struct SilhouetteEdge {
  std::uint32_t edge = 0;
  int multiplicity = 0;  ///< never 0

  friend bool operator==(const SilhouetteEdge&, const SilhouetteEdge&) = default;
};

/// Returns the edges with k_e(p) ≠ 0, in ascending order. Exact.
std::vector<SilhouetteEdge> silhouette_edges(const MeshView& mesh, const EdgeGraph& graph, const glm::dvec3& p);

/// Returns the edges that may be silhouettes as seen from some point of the convex hull of `corners` (a light's
/// corners, the corners of a box of receivers), ascending: conservative, and exact except for edges with triangles that
/// the hull's points see from both sides. No edge is missed: (a, b, c; p) is affine in p, so a triangle whose sign is
/// the same at every corner has that sign on the whole hull. An edge is dropped only if all its triangles have such a
/// sign and these sum to 0, or if they cancel in pairs: two triangles on the same plane and on opposite sides of the
/// edge have opposite signs for every p.
std::vector<std::uint32_t> possible_silhouette_edges(const MeshView& mesh, const EdgeGraph& graph,
                                                     std::span<const glm::dvec3> corners);

}  // namespace penumbra::mesh
