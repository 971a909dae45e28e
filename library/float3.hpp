#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <span>
#include <vector>

namespace penumbra {

/// The same numbers as the interface has them: GLM's vectors are three floats one after the other, too.
inline std::span<const std::array<float, 3>> as_floats(const std::vector<glm::vec3>& values) {
  static_assert(sizeof(glm::vec3) == sizeof(std::array<float, 3>));
  return {reinterpret_cast<const std::array<float, 3>*>(values.data()), values.size()};
}

}  // namespace penumbra
