#pragma once

#include <glm/vec3.hpp>

#include <cmath>

namespace penumbra::vectors {

/// The sum of the components' sizes: bounds the length.
inline double size1(const glm::dvec3& x) {
  return std::abs(x.x) + std::abs(x.y) + std::abs(x.z);
}

}  // namespace penumbra::vectors
