// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

#include <vector>

namespace penumbra::visibility {

/// Returns the part of a convex polygon with coordinate `axis` at most `limit` (Sutherland and Hodgman 1974), in the
/// same order.
std::vector<glm::dvec2> clipped_above(const std::vector<glm::dvec2>& polygon, int axis, double limit);
/// Returns the part with coordinate `axis` at least `limit`.
std::vector<glm::dvec2> clipped_below(const std::vector<glm::dvec2>& polygon, int axis, double limit);

/// Returns the area of a polygon without self-intersections, for either orientation.
double area_of(const std::vector<glm::dvec2>& polygon);

}  // namespace penumbra::visibility
