#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <optional>

namespace penumbra::visibility {

/// Does the open segment p→l meet the triangle, if double arithmetic is certain: no sign on the way is within its
/// rounding. As segment_meets_triangle (pair_truth.hpp) where both say something; p and l may be no floats. `off`: how
/// far l may be from where it is meant to be.
std::optional<bool> certainly_meets(const glm::dvec3& p, const glm::dvec3& l, const std::array<glm::vec3, 3>& corners,
                                    double off = 0);

/// Likewise of the ray p + t · way, t > 0.
std::optional<bool> ray_certainly_meets(const glm::dvec3& p, const glm::dvec3& way,
                                        const std::array<glm::vec3, 3>& corners);

}  // namespace penumbra::visibility
