// SPDX-License-Identifier: Apache-2.0
// Computes the depth of receivers and the box with the light's second moments (map_frame.hpp).

#include "maps/products/map_frame.hpp"

#include "maps/products/light_shape.hpp"
#include "visibility/receivers.hpp"

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace penumbra::maps {
namespace {

/// Returns the mean of x² and of y² over a flat convex polygon around its centroid 0: over a triangle with corners a,
/// b, c the mean is (a² + b² + c² + (a + b + c)²) / 12, and the polygon is a fan of triangles around its first corner.
glm::dvec2 second_moments(const std::vector<glm::dvec2>& corners) {
  glm::dvec2 moments(0);
  double area = 0;
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const glm::dvec2 &a = corners[0], &b = corners[i], &c = corners[i + 1];
    const double twice = std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    const glm::dvec2 sum = a + b + c;
    moments += twice / 12 * (a * a + b * b + c * c + sum * sum);
    area += twice;
  }
  return area > 0 ? moments / area : glm::dvec2(0);
}

}  // namespace

glm::dvec2 half_box(const visibility::Light& light, const LightBasis& basis) {
  if (is_circle(light.kind)) return glm::dvec2(std::sqrt(3.0) / 2 * light.radius);
  if (is_round(light.kind)) {
    const LightBounds bounds = light_bounds(light, basis);  // the mean of x² is a quarter of the largest x²
    return std::sqrt(3.0) / 2 * bounds.upper;
  }
  return glm::sqrt(3.0 * second_moments(light_outline(light, basis)));
}

MapFrame::MapFrame(const render::Device& device) : frame_(device, "map frame", sizeof(gpu::MapFrame)) {}

void MapFrame::record(render::Commands& /*commands*/, const MapSet& maps) {
  gpu::MapFrame frame{.deepest = {0, 0},
                      .half_box = half_box(maps.light, maps.basis),
                      .smallest_near = static_cast<float>(half_width(maps.light))};
  for (std::uint32_t i = 0; i < maps.scene.triangles.size(); ++i) {
    if (!visibility::is_receiver(maps.scene, maps.light, i)) continue;
    for (const glm::vec3& corner : maps.scene.corners(i)) {
      const auto height = static_cast<float>(maps.basis.local(corner).z);
      frame.deepest[0] = std::max(frame.deepest[0], height);
      frame.deepest[1] = std::max(frame.deepest[1], -height);
    }
  }
  frame_.write<gpu::MapFrame>(std::span(&frame, 1));
}

}  // namespace penumbra::maps
