#pragma once

#include <glm/vec3.hpp>

#include <cmath>

namespace penumbra {

/// The sum of the components' sizes: bounds the length.
template <typename T>
T size1(const glm::vec<3, T>& x) {
  return std::abs(x.x) + std::abs(x.y) + std::abs(x.z);
}

}  // namespace penumbra
