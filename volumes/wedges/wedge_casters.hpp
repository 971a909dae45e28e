// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/edge_graph.hpp"
#include "mesh/silhouettes.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "volumes/wedges/penumbra_wedge.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

/// Selection of the edges of a scene that cast penumbrae.
///
/// The *crop* of an edge (Lehtinen et al. 2006; here for any soup). Let o_T(q) be the sign of (a, b, c; q) for a
/// triangle T with apex c at the edge a b; k_e(q) = Σ o_T(q). For p = x + t (x − l), x on the edge, t > 0: T's plane
/// height h_T is affine and 0 at x, so h_T(p) = −t h_T(l), o_T(p) = −o_T(l), and k_e(p) = −k_e(l). Let all triangles
/// but one, T, have the same sign ≠ 0 at all corners of the light's hull, hence on all of the hull, and let these signs
/// sum to s = ±1. Then k_e(l) = s + o_T(l) is 0 exactly where o_T(l) = −s. So k_e(p) ≠ 0 implies s h_T(l) ≥ 0, and
/// therefore s h_T(p) ≤ 0: one half-space. In every other case there is no crop:
/// - both triangles of a two-triangle edge are mixed (the light is on both sides of their planes), or one of them only
///   *touches* the light: the l with k_e(l) ≠ 0 are no longer on one side of a plane;
/// - an open edge (one triangle): k_e(l) = o_T(l) is 0 on T's plane only;
/// - a non-manifold edge with two or more mixed triangles; or with a sum of the other signs that is 0 (as an open edge)
///   or beyond ±1 (k_e is never 0).
namespace penumbra::volumes {

/// Triangles that cast shadows of a light (without the light's own body), each of their edges once. Positions are all
/// scene floats; `triangle` is the scene's index of each triangle.
struct Casters {
  std::vector<glm::dvec3> positions;
  std::vector<mesh::Triangle> triangles;
  std::vector<std::uint32_t> triangle;
  mesh::EdgeGraph graph;

  [[nodiscard]] mesh::MeshView view() const { return {positions, triangles}; }
};
Casters casters_of(const visibility::SceneFloats& scene, const visibility::Light& light);

/// Returns the whole soup as casters: for meshes without a scene. Coordinates are unchanged.
Casters casters_of(const mesh::TriangleSoup& soup);

/// Returns the bounding box of all positions, used to cut polyhedra. An axis without extent (a flat scene) is enlarged
/// by a sixteenth of the largest extent on either side.
Box bounds_of(const Casters& casters);

enum class SilhouettesFrom {
  center,    ///< k_e(the light's centre) ≠ 0
  anywhere,  ///< possibly k_e(l) ≠ 0 for some l in the light's hull
};

struct CastingEdges {
  std::vector<std::uint32_t> edges;  ///< indices in the graph, ascending
  std::vector<WedgeEdge> wedges;     ///< for each edge, the input of build_wedges
};

/// Returns the edges that cast penumbrae. `crop`: also bound the wedges by the planes of their triangles, where such a
/// bound follows; only with `anywhere`.
CastingEdges casting_edges(const Casters& casters, const LightHull& light, SilhouettesFrom from, bool crop);

/// Triangle T of the crop of one edge of the graph, and the sum s of the other signs. crop_of returns nullopt where no
/// crop follows. Exact.
struct Crop {
  std::array<glm::dvec3, 3> triangle;  ///< a, b, apex
  int others = 0;                      ///< s
};
std::optional<Crop> crop_of(const Casters& casters, std::uint32_t edge, const LightHull& light);

/// Returns a half-space that contains all p of the edge's penumbra with s h_T(p) ≤ 0, rounded outward. It contains the
/// edge's ends. Its normal n satisfies, for some κ > 0, n · (x − l) ≥ κ s h_T(l) for the ends x and all corners l. Both
/// sides are affine in x and l, so where s h_T(l) ≥ 0, n · (x − l) ≥ 0 on all of edge and light. Returns nullopt if the
/// rounding would change the normal by more than 2⁻²⁰ of its size.
std::optional<Plane> crop_plane(const Crop& crop, const EdgeAndLight& cast);

}  // namespace penumbra::volumes
