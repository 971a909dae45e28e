#pragma once

#include <glm/vec2.hpp>

#include <vector>

namespace penumbra::visibility {

/// What of a convex polygon has coordinate `axis` at most `limit` (Sutherland and Hodgman 1974), in the same order.
std::vector<glm::dvec2> clipped_above(const std::vector<glm::dvec2>& polygon, int axis, double limit);
/// The same, at least `limit`.
std::vector<glm::dvec2> clipped_below(const std::vector<glm::dvec2>& polygon, int axis, double limit);

/// Of a polygon without crossings; in either order.
double area_of(const std::vector<glm::dvec2>& polygon);

}  // namespace penumbra::visibility
