#pragma once

#include "engines/vectors/light_grid.hpp"
#include "engines/vectors/near_casters.hpp"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <tuple>

/// Casters at the disk that a view sample sees of a sphere, as where a lamp's own body reaches into it.
/// docs/edge-scatter.md, "Ends".
namespace penumbra::vectors {

/// The disk's plane, in double. A vertex is on one side of it and a side of a caster passes through it at one place,
/// whichever edge or triangle asks; vectors ask with the same operations.
struct DiskPlane {
  DiskPlane(const LightCone& cone, const glm::dvec3& from);

  /// Over p, less that of the plane; 0 and more is behind the disk.
  [[nodiscard]] double height(const glm::dvec3& x) const { return dot(axis, x - p) - end; }
  /// (s, t) of the foot of x in the plane: the unit disk.
  [[nodiscard]] glm::dvec2 place(const glm::dvec3& x) const { return {dot(u, x - p), dot(v, x - p)}; }
  /// The place where the segment between points on either side passes through, the lexicographically first one given
  /// first.
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

/// Within this of the plane floats do not know on which side of it something is.
double slab_of(const LightGrid::Cones& cones);
/// How much larger than the disk's the square is in which casters matter, given errors of places there.
double around_disk(const LightGrid::Cones& cones, const LightCone& cone);

/// Does a caster's part within `slab` of the plane come within ±`around` of the disk's middle?
bool meets_disk(const DiskPlane& plane, const NearCaster& caster, double slab, double around);

}  // namespace penumbra::vectors
