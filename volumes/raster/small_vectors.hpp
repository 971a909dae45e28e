// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cmath>

namespace penumbra::volumes {

/// Returns the sum of the components' absolute values.
inline double norm1(const glm::dvec3& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

/// Copies a vector into a member of push constants, where a vector is an array of three doubles.
inline void store(double (&to)[3], const glm::dvec3& from) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

}  // namespace penumbra::volumes
