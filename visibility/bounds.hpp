// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

namespace penumbra::visibility {

/// An axis-aligned box.
struct Bounds {
  glm::vec3 lower{0}, upper{0};
};

}  // namespace penumbra::visibility
