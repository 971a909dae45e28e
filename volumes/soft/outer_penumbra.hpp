// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

namespace penumbra::volumes {

/// A spherical light around `center` that replaces any light. Let h be an edge's height over the receiver's plane, and
/// g the light's height over the edge: the edge darkens points within `radius` · h / g of its hard shadow (E. Haines
/// 2001).
struct OuterPenumbra {
  glm::dvec3 center{0};
  double radius = 0;

  /// Returns the depth of p, on a plane with this normal, in the outer penumbra of the edge a b: 1 on the edge's
  /// projection from the centre, 0 at its disks' rims and beyond. The C++ twin of plateaus.frag.
  [[nodiscard]] double depth_at(const glm::dvec3& p, const glm::dvec3& normal, const glm::dvec3& a,
                                const glm::dvec3& b) const;
};

/// Returns the hidden share of the light at this depth: 3 τ² − 2 τ³, in place of (1 + sin(π τ − π/2)) / 2 (S. Parker et
/// al. 1998).
inline double hidden_at(double depth) {
  return depth * depth * (3 - 2 * depth);
}

}  // namespace penumbra::volumes
