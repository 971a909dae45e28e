#pragma once

#include <glm/vec3.hpp>

namespace penumbra::visibility {

/// A box along the axes.
struct Bounds {
  glm::vec3 lower{0}, upper{0};
};

}  // namespace penumbra::visibility
