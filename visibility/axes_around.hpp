// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cmath>

namespace penumbra::visibility {

/// Two axes of a plane.
struct Axes {
  glm::dvec3 u, v;
};

/// Returns orthonormal u, v with u × v = n (unit): Duff et al., "Building an orthonormal basis, revisited" (JCGT 2017).
inline Axes axes_around(const glm::dvec3& n) {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1 / (sign + n.z), b = n.x * n.y * a;
  return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

}  // namespace penumbra::visibility
