// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cmath>

namespace penumbra {

/// Returns the sum of the components' magnitudes, an upper bound of the length.
template <typename T>
T size1(const glm::vec<3, T>& x) {
  return std::abs(x.x) + std::abs(x.y) + std::abs(x.z);
}

}  // namespace penumbra
