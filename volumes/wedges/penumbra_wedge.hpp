// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/wedges/light_hull.hpp"
#include "volumes/wedges/wedge_plane.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

/// Penumbra wedges: sets of a few half-spaces whose intersection contains the penumbra of an edge (wedge_plane.hpp).
/// All coordinates are scene floats (relative to the scene's origin), as doubles.
namespace penumbra::volumes {

enum class Construction {
  /// Construction of Assarsson and Akenine-Möller 2003 (course notes, 5.3.2.2): the endpoint farther from the light's
  /// centre is moved towards the centre until both are equally far; front and back plane contain the moved edge and
  /// touch the light from either side; left and right plane contain an endpoint and the direction edge × (centre −
  /// endpoint), and touch the light.
  original,
  /// Facets of the convex hull of the penumbra, e + cone{x − l}; in no paper. The wedge is the penumbra's closure,
  /// since the penumbra is convex (wedge_tightness.hpp).
  tight,
};

enum class WedgeOutcome {
  wedge,       ///< bounded by `planes`
  split,       ///< no planes; its two pieces follow, with `parent`
  everywhere,  ///< the edge touches the light, or no planes can be proved: every p may be in the edge's penumbra
  empty,       ///< no p is in the penumbra: an edge of no length
};
const char* name_of(WedgeOutcome outcome);

struct Wedge {
  glm::dvec3 a{0}, b{0};  ///< the edge, or a piece of the edge
  WedgeOutcome outcome = WedgeOutcome::wedge;
  std::vector<Plane> planes;            ///< p is inside iff every half-space holds, evaluated exactly
  std::optional<std::uint32_t> parent;  ///< the `split` wedge whose piece this wedge is
  std::uint32_t source = 0;             ///< the edge's index in the caller's list
};

struct WedgeEdge {
  glm::dvec3 a{0}, b{0};
  /// Half-spaces, other than those of the penumbra, that the caller proved to contain the requested points: the planes
  /// of adjacent triangles (Lehtinen et al. 2006). Added to every wedge of the edge.
  std::vector<Plane> crop;
};

/// Builds the wedges of all edges, in order; the pieces of a split edge follow it. Every plane satisfies
/// bounds_penumbra: rounding goes outward. Deterministic; parallel.
///
/// Outcomes by case (course notes, figure 5.16, and beyond):
/// | case | original | tight |
/// | --- | --- | --- |
/// | edge clear of the light | wedge, up to 4 planes | wedge |
/// | edge points at the light (its moved line meets it) | split, then everywhere | wedge: the nearer endpoint's cone |
/// | edge longer than its distance | wedge or split | wedge |
/// | edge through the light's plane, beside the light | wedge or split | wedge |
/// | edge in its own penumbra; adjacent wedges overlap | wedge: wedges are independent | the same |
/// | edge touches or crosses the light | everywhere | everywhere |
/// | edge of no length | empty | empty |
std::vector<Wedge> build_wedges(std::span<const WedgeEdge> edges, const LightHull& light, Construction construction);

/// Returns whether p is inside all half-spaces of the wedge. Exact.
bool is_inside(const Wedge& wedge, const glm::dvec3& p);

}  // namespace penumbra::volumes
