// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace penumbra::visibility {

/// Returns one of the points that light_points_for gives for a sphere, on the disk that p sees (light_frame_from). + 0
/// turns −0 into +0.
inline glm::vec3 sphere_point(const LightFrame& seen, const glm::dvec2& st) {
  return glm::vec3(seen.center + st.x * seen.u + st.y * seen.v) + 0.0f;
}

}  // namespace penumbra::visibility
