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

/// Which edges of a scene cast penumbrae.
///
/// The *crop* of an edge (Lehtinen et al. 2006; here for any soup). Let o_T(q) be the sign of (a, b, c; q) for a
/// triangle T with apex c around the edge a b; k_e(q) = Σ o_T(q). For p = x + t (x − l), x on the edge, t > 0: T's
/// plane h_T is affine and 0 at x, so h_T(p) = −t h_T(l), o_T(p) = −o_T(l), and k_e(p) = −k_e(l). Let all triangles but
/// one, T, have the same sign ≠ 0 at all corners of the light's hull, hence on all of it, and let these signs sum to s
/// = ±1. Then k_e(l) = s + o_T(l) is 0 exactly where o_T(l) = −s; so k_e(p) ≠ 0 implies s h_T(l) ≥ 0, that is s h_T(p)
/// ≤ 0: one half-space. In every other case there is none:
/// - both triangles of a two-triangle edge mixed, or one of them only *touching* the light: the l with k_e(l) ≠ 0 are
///   no longer on one side of a plane;
/// - an open edge (one triangle): k_e(l) = o_T(l) is 0 on T's plane only;
/// - a non-manifold edge with two or more mixed triangles; or with a sum of the others that is 0 (as an open edge) or
///   beyond ±1 (k_e is never 0).
namespace penumbra::volumes {

/// The triangles that cast shadows in a light's light (not its own body), their edges once each. Positions are all
/// scene floats; `triangle` says which of the scene's each triangle is.
struct Casters {
  std::vector<glm::dvec3> positions;
  std::vector<mesh::Triangle> triangles;
  std::vector<std::uint32_t> triangle;
  mesh::EdgeGraph graph;

  [[nodiscard]] mesh::MeshView view() const { return {positions, triangles}; }
};
Casters casters_of(const visibility::SceneFloats& scene, const visibility::Light& light);

/// The whole soup as casters: for meshes that are no scene. Coordinates as they are.
Casters casters_of(const mesh::TriangleSoup& soup);

/// The bounding box of all positions, which polyhedra are cut by. Where it has no extent (a flat scene), it is made
/// thicker by a sixteenth of its largest on either side.
Box bounds_of(const Casters& casters);

enum class SilhouettesFrom {
  center,    ///< k_e(the light's centre) ≠ 0
  anywhere,  ///< perhaps k_e(l) ≠ 0 for some l in the light's hull
};

struct CastingEdges {
  std::vector<std::uint32_t> edges;  ///< of the graph, ascending
  std::vector<WedgeEdge> wedges;     ///< for each: what build_wedges wants
};

/// `crop`: bound them by the planes of their triangles, too, where that follows; only with `anywhere`.
CastingEdges casting_edges(const Casters& casters, const LightHull& light, SilhouettesFrom from, bool crop);

/// For one edge of the graph, the triangle T of the crop and the sum s of the others; nothing where no crop follows.
/// Exact.
struct Crop {
  std::array<glm::dvec3, 3> triangle;  ///< a, b, apex
  int others = 0;                      ///< s
};
std::optional<Crop> crop_of(const Casters& casters, std::uint32_t edge, const LightHull& light);

/// A half-space that contains all p of the edge's penumbra with s h_T(p) ≤ 0, rounded outward. It holds at the edge's
/// ends and, with its normal n and some κ > 0, n·(x − l) ≥ κ s h_T(l) for the ends x and all corners l: both sides are
/// affine in x and l, so where s h_T(l) ≥ 0, n·(x − l) ≥ 0 on all of edge and light. Nothing if the rounding would take
/// more than 2⁻²⁰ of the normal.
std::optional<Plane> crop_plane(const Crop& crop, const EdgeAndLight& cast);

}  // namespace penumbra::volumes
