// SPDX-License-Identifier: Apache-2.0
// The window of a light: a parallelogram of its plane, exact in the light's stored numbers.

#include "volumes/edges/light_window.hpp"

#include "base/size1.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <cmath>

namespace penumbra::volumes {
LightWindow window_of(const visibility::Light& light) {
  LightWindow window;
  if (!is_polygon(light.kind)) return window;
  const auto [center, u, v] = visibility::light_frame(light);
  window.shear = glm::dot(u, v) / glm::dot(u, u);
  const glm::dvec3 across = v - window.shear * u, n = glm::cross(u, v);
  const double squared = glm::dot(n, n);
  window.low = window.high = glm::dvec2(0);  // the frame's centre is a corner
  for (const glm::vec3& corner : light.outline) {
    const glm::dvec3 from = glm::dvec3(corner) - center;
    const glm::dvec2 at = glm::dvec2(glm::dot(glm::cross(across, n), from), glm::dot(glm::cross(n, u), from)) / squared;
    window.low = glm::min(window.low, at);
    window.high = glm::max(window.high, at);
  }
  const glm::dvec2 margin = window.size() / 64.0;
  window.low -= margin;
  window.high += margin;
  return window;
}

WindowAxes axes_of(const visibility::Light& light, const LightWindow& window) {
  const auto [center, u, v] = visibility::light_frame(light);
  const glm::dvec3 up = v - window.shear * u;
  const glm::dvec2 size = window.size();
  return {center + window.low.x * u + window.low.y * up, size.x * u, size.y * up,
          size1(u) * size1(v) / glm::length(glm::cross(u, v))};
}

}  // namespace penumbra::volumes
