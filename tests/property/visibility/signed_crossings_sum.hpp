// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/edge_graph.hpp"
#include "mesh/predicates.hpp"
#include "visibility/light_samples.hpp"

#include <glm/vec3.hpp>

#include <span>

namespace penumbra::visibility {

/// A view point p and a light point l, as stored. Lengths in scene floats.
struct CrossingPair {
  glm::vec3 p{0}, l{0};
};

/// Signed crossings of a ray with the edges of clipped triangles. The parts show how much of the answer depends on
/// clipping; only their sum has a meaning by itself.
struct SignedCrossings {
  int edges = 0;          ///< Σ over the graph's edges, clipped, each k_e(p) times
  int cuts_at_light = 0;  ///< Σ over the triangles' cut edges in the plane through l
  int cuts_at_p = 0;      ///< Σ over the triangles' cut edges in the plane through p

  /// The number of triangles that the open segment p→l meets: segment_meets_triangle summed over the graph's triangles,
  /// zero predicates included.
  [[nodiscard]] int total() const { return edges + cuts_at_light + cuts_at_p; }
};

/// Returns how many triangles are between p and l, counted from edges alone: every edge once with its signed
/// multiplicity k_e(p), every triangle's facing once. Exact for the stored numbers; derivation and tie rules are in
/// docs/signed-crossings.md. The slab is between the plane through l along the light's frame and the parallel plane
/// through p: a light point that rounding moved off its light's plane is no special case.
///
/// `mesh` and `graph` are the triangles that count: the caller leaves out carriers. `facings` is mesh::facings(mesh,
/// graph, p). The light must be planar, and p off the plane through l: both are asserted.
SignedCrossings signed_crossings(const mesh::MeshView& mesh, const mesh::EdgeGraph& graph,
                                 std::span<const mesh::Side> facings, const CrossingPair& pair, const Light& light);

}  // namespace penumbra::visibility
