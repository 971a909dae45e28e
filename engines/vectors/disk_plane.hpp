// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/vectors/light_grid.hpp"
#include "engines/vectors/near_casters.hpp"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <tuple>

/// Casters at the disk that a view sample sees of a sphere light. This is for casters that reach into the light, such
/// as a lamp's own body. docs/edge-scatter.md, "Ends".
namespace penumbra::vectors {

/// The disk's plane, in double. All edges and triangles get the same result for the side of the plane that a common
/// vertex is on, and for the place where a common edge crosses the plane; vector code uses the same operations.
struct DiskPlane {
  DiskPlane(const LightCone& cone, const glm::dvec3& from);

  /// Signed distance of x from the disk's plane along the axis; ≥ 0: behind the disk.
  [[nodiscard]] double height(const glm::dvec3& x) const { return dot(axis, x - p) - end; }
  /// Returns (s, t) of the orthogonal projection of x onto the plane: the disk is the unit disk.
  [[nodiscard]] glm::dvec2 place(const glm::dvec3& x) const { return {dot(u, x - p), dot(v, x - p)}; }
  /// Returns the place where the segment between points on either side crosses the plane; `first` must be the
  /// lexicographically smaller point.
  [[nodiscard]] glm::dvec2 pass(const glm::dvec3& first, const glm::dvec3& second) const {
    const double h = height(first);
    const glm::dvec2 from = place(first);
    return from + h / (h - height(second)) * (place(second) - from);
  }

  glm::dvec3 p, axis, u, v;
  double end;

 private:
  static double dot(const glm::dvec3& n, const glm::dvec3& x) { return (n.x * x.x + n.y * x.y) + n.z * x.z; }
};
inline bool comes_first(const glm::dvec3& a, const glm::dvec3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

/// Returns the distance from the plane within which float arithmetic does not determine a point's side.
double slab_of(const LightGrid::Cones& cones);
/// Returns the size of the square in which casters matter, relative to the disk's, given the errors of places there.
double around_disk(const LightGrid::Cones& cones, const LightCone& cone);

/// Returns whether a caster's part within `slab` of the plane comes within ±`around` of the disk's centre.
bool meets_disk(const DiskPlane& plane, const NearCaster& caster, double slab, double around);

}  // namespace penumbra::vectors
