// SPDX-License-Identifier: Apache-2.0
// Polygons: flat and convex, with their own corners.

#include "visibility/lights/form_factor.hpp"
#include "visibility/lights/kinds/light_kinds.hpp"
#include "visibility/pair_truth.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>
#include <vector>

namespace penumbra::visibility {
namespace {

/// Returns the smallest of a triangle's heights: the rotation of its plane by a rounded corner is inversely
/// proportional to it.
double least_height(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
  return longest > 0 ? glm::length(glm::cross(b - a, c - a)) / longest : 0;
}

/// Returns the least height of a triangle of stored corners that may define the polygon's plane. With this height,
/// rounding one corner, by at most √3 · 2⁻²⁴ of the largest coordinate, rotates the plane by at most √3 / 128 (0.8
/// degrees), and rounding all three by at most twice that: gradients of barycentric coordinates are no longer than 1 /
/// height and add up to 0. For a polygon too small for that, the result is about an eighth of its largest height.
double enough_height(const std::vector<glm::vec3>& corners) {
  const glm::dvec3 first(corners.front());
  glm::dvec3 farthest = first;
  double largest = 0, highest = 0;
  for (const glm::dvec3 corner : corners) {
    if (!(glm::length(corner) < 1e30)) return 0;
    largest = std::max({largest, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
    if (glm::length(corner - first) > glm::length(farthest - first)) farthest = corner;
  }
  for (const glm::dvec3 corner : corners) highest = std::max(highest, least_height(first, farthest, corner));
  return std::min(0x1p-17 * largest, highest / 8);
}

/// A fan around the first corner: x runs along the far edges in proportion to the fan triangles' areas, √y from the
/// corner outward. Continuous, and areas stay in proportion: d(area) = 2·A·√y · d√y · dx' = A dy dx'.
void make_polygon(const scenes::LightShape& shape, const LightBuilder& to) {
  Light& light = to.light;
  const std::vector<glm::dvec3>& corners = std::get<scenes::Polygon>(shape).vertices;
  const std::size_t count = corners.size();
  if (count < 3) to.refuse_zero_area(" (a polygon needs three corners)");

  std::vector<double> area_up_to(count - 1, 0.0);  // of the fan triangles 1 … i; triangle i has corners 0, i, i + 1
  glm::dvec3 normal{0};                            // length: twice the polygon's area
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const glm::dvec3 doubled = glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    normal += doubled;
    area_up_to[i] = area_up_to[i - 1] + glm::length(doubled) / 2;
  }
  light.area = area_up_to.back();
  if (!(light.area > 0)) to.refuse_zero_area(" (its corners lie on a line)");
  for (const glm::dvec3& corner : corners) light.outline.push_back(to.stored(corner));

  // Chooses the plane for condition (2) of the truth of a pair: that of the first three corners that are not on a line,
  // nor so nearly on one that rounding would determine the plane. If rounding has reversed them, they are swapped so
  // that the light still emits to the intended side.
  const double enough = enough_height(light.outline);
  bool found = false;
  for (std::size_t i = 0; i < count && !found; ++i) {
    for (std::size_t j = i + 1; j < count && !found; ++j) {
      for (std::size_t k = j + 1; k < count && !found; ++k) {
        const glm::vec3 &a = light.outline[i], &b = light.outline[j], &c = light.outline[k];
        if (!is_finite_point(a) || !is_finite_point(b) || !is_finite_point(c) || collinear(a, b, c) ||
            least_height(a, b, c) < enough)
          continue;
        const glm::dvec3 stored_normal = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
        const bool turned = glm::dot(stored_normal, normal) < 0;
        light.center = a;
        light.center_u = turned ? c : b;
        light.center_v = turned ? b : c;
        found = true;
      }
    }
  }
  const bool all_finite = std::all_of(light.outline.begin(), light.outline.end(), is_finite_point);
  if (!found && all_finite) to.refuse_zero_area(" in float32 relative to the scene's origin");

  // Coordinates: [−1, 1]² over the polygon's bounding rectangle, x along the fan's longest spoke.
  glm::dvec3 spoke{0};
  for (const glm::dvec3& corner : corners) {
    if (glm::length(corner - corners[0]) > glm::length(spoke)) spoke = corner - corners[0];
  }
  const glm::dvec3 x_axis = spoke / glm::length(spoke), y_axis = glm::cross(normal / glm::length(normal), x_axis);
  const auto flat = [&](const glm::dvec3& q) {
    return glm::dvec2(glm::dot(q - corners[0], x_axis), glm::dot(q - corners[0], y_axis));
  };
  glm::dvec2 lower = flat(corners[0]), upper = lower;
  for (const glm::dvec3& corner : corners) {
    lower = glm::min(lower, flat(corner));
    upper = glm::max(upper, flat(corner));
  }

  for (const glm::dvec2& sample : to.unit) {
    const double along = sample.x * light.area;
    std::size_t i = 1;
    while (i + 2 < count && along >= area_up_to[i]) ++i;
    const double fraction = std::clamp((along - area_up_to[i - 1]) / (area_up_to[i] - area_up_to[i - 1]), 0.0, 1.0);
    const glm::dvec3 far_point = corners[i] + fraction * (corners[i + 1] - corners[i]);
    const glm::dvec3 world = corners[0] + std::sqrt(sample.y) * (far_point - corners[0]);
    to.add_sample(glm::clamp(2.0 * (flat(world) - lower) / (upper - lower) - 1.0, -1.0, 1.0), world);
  }
}

bool is_polygon_above_horizon(const UnshadowedLight& seen) {
  return std::ranges::all_of(seen.light().outline,
                             [&](const glm::vec3& q) { return glm::dot(seen.normal(), glm::dvec3(q) - seen.p()) > 0; });
}

double polygon_form_factor(const UnshadowedLight& seen) {
  const Light& light = seen.light();
  const glm::dvec3 center = seen.frame().center, &along = seen.along(), &n = seen.normal();
  // Computed in the frame's plane, as V and parts are: three corners that are close together may tilt it considerably.
  const auto in_plane = [&](const glm::dvec3& direction) { return direction - glm::dot(along, direction) * along; };
  FormFactorLoop loop(n);
  for (std::size_t i = 0; i < light.outline.size(); ++i) {
    const glm::dvec3 from(light.outline[i]), to(light.outline[(i + 1) % light.outline.size()]);
    const glm::dvec3 a = center + in_plane(from - glm::dvec3(light.center)),
                     b = center + in_plane(to - glm::dvec3(light.center));
    loop.add({a, b, in_plane(to - from)}, glm::dot(n, a), glm::dot(n, b));
  }
  return std::abs(loop.sum());  // an outline may have either orientation
}

}  // namespace

const LightBehaviour kPolygonBehaviour{make_polygon, is_polygon_above_horizon, polygon_form_factor};

}  // namespace penumbra::visibility
