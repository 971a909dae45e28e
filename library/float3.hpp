// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <span>
#include <vector>

namespace penumbra {

/// Returns the same memory in the interface's type: GLM's vectors also are three consecutive floats.
inline std::span<const std::array<float, 3>> as_floats(const std::vector<glm::vec3>& values) {
  static_assert(sizeof(glm::vec3) == sizeof(std::array<float, 3>));
  return {reinterpret_cast<const std::array<float, 3>*>(values.data()), values.size()};
}

}  // namespace penumbra
