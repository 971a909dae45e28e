// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/wedges/penumbra_wedge.hpp"

#include <optional>
#include <span>
#include <vector>

/// Ratio of the size of a wedge to the size of its penumbra, on receiver planes.
///
/// The penumbra of an edge e under a convex light L is convex, so its cross-section with a plane is a convex polygon.
/// Proof: for p and q in the penumbra there are x ∈ e on the segment p l and y ∈ e on q m (l, m ∈ L). Any r between p
/// and q and the segment l m span a triangle that divides the tetrahedron p q l m into two pieces, one with p l on its
/// border and one with q m. The segment x y ⊂ e leads from one piece to the other, so it meets the triangle in a point
/// z, and the ray r→z meets l m ⊂ L.
/// Hence, on a plane that leaves light and edge on one side, the penumbra is the hull of the light's corners as
/// projected through the two ends of the edge. The hull of the whole penumbra, e + cone{x − l}, is no larger than its
/// closure: the tight wedge is the penumbra. A cropped wedge is compared with the whole penumbra, so its ratio may be
/// below 1.
namespace penumbra::volumes {

/// Area of the wedge's cross-section ÷ area of the penumbra's. It is measured on three planes across the penumbra:
/// half, once and twice as far beyond the edge as the light is on the near side of the edge. In double.
struct Tightness {
  std::vector<double> ratios;  ///< of bounded cross-sections, ascending
  std::size_t unbounded = 0;   ///< cross-sections that extend beyond 16 times the penumbra's extent: a plane is missing
  std::size_t not_measured = 0;  ///< penumbrae without area on such a plane
};

/// Measures `wedges`. `shape`: corners of the light itself, if the hull is larger (disk, sphere); else the hull's
/// corners.
Tightness tightness_of(std::span<const Wedge> wedges, const LightHull& light, std::span<const glm::dvec3> shape);

/// Returns the share-quantile of an ascending list, 0 ≤ share ≤ 1; nullopt for an empty list.
std::optional<double> quantile(std::span<const double> ascending, double share);

}  // namespace penumbra::volumes
