// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <optional>

namespace penumbra::visibility {

/// Returns whether the open segment p→l meets the triangle, if double arithmetic is certain, that is, if no sign is
/// within its rounding; else nullopt. Agrees with segment_meets_triangle (pair_truth.hpp) where both have a result; p
/// and l need not be floats. `off`: error of l.
std::optional<bool> certainly_meets(const glm::dvec3& p, const glm::dvec3& l, const std::array<glm::vec3, 3>& corners,
                                    double off = 0);

/// Returns whether the ray p + t · direction, t > 0, meets the triangle; nullopt if uncertain.
std::optional<bool> ray_certainly_meets(const glm::dvec3& p, const glm::dvec3& direction,
                                        const std::array<glm::vec3, 3>& corners);

}  // namespace penumbra::visibility
