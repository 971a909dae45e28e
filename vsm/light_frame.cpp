#include "vsm/light_frame.hpp"

#include "base/assert.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra::vsm {
namespace {

/// A rectangle in the light's plane, in double, unscaled: the rectangle itself, or one around any other planar light.
struct Span {
  glm::dvec3 center, u, v;
};

Span span_of(const visibility::Light& light) {
  const glm::dvec3 center(light.center), to_u = glm::dvec3(light.center_u) - center, to_v = glm::dvec3(light.center_v) - center;
  if (light.kind == visibility::LightKind::rectangle) return {center, to_u, to_v};
  const glm::dvec3 axis_u = glm::normalize(to_u);
  const glm::dvec3 axis_v = glm::normalize(glm::cross(glm::cross(to_u, to_v), axis_u));
  glm::dvec2 lower(0), upper(0);
  const auto include = [&](const glm::vec3& point) {
    const glm::dvec2 at(glm::dot(glm::dvec3(point) - center, axis_u), glm::dot(glm::dvec3(point) - center, axis_v));
    lower = glm::min(lower, at);
    upper = glm::max(upper, at);
  };
  for (const glm::vec3& corner : light.outline) include(corner);
  for (const glm::vec3& point : light.points) include(point);
  const glm::dvec2 middle = 0.5 * (lower + upper), half = 0.5 * (upper - lower);
  return {center + middle.x * axis_u + middle.y * axis_v, half.x * axis_u, half.y * axis_v};
}

/// (s, t) of one stored point in the frame as rounded. u and v are (nearly) orthogonal, but nothing here needs that.
glm::vec2 coordinates_of(const LightFrame& frame, const glm::dvec3& point) {
  const glm::dvec3 u(frame.u), v(frame.v), at = point - glm::dvec3(frame.center);
  const double uu = glm::dot(u, u), vv = glm::dot(v, v), uv = glm::dot(u, v), det = uu * vv - uv * uv;
  const double along_u = glm::dot(at, u), along_v = glm::dot(at, v);
  const glm::dvec2 exact((along_u * vv - along_v * uv) / det, (along_v * uu - along_u * uv) / det);
  return glm::vec2(glm::clamp(exact, glm::dvec2(-1), glm::dvec2(1)));
}

std::vector<glm::vec2> row_starts_of(const visibility::Light& light) {
  std::vector<glm::vec2> starts;
  if (light.kind != visibility::LightKind::rectangle || light.rows == 0) return starts;
  for (std::uint32_t row = 0; row < light.rows; ++row) {
    const double shift = light.row_shift.empty() ? 0.0 : light.row_shift[row];
    starts.emplace_back(2.0 * (0.5 + shift) / light.columns - 1.0, 2.0 * (row + 0.5) / light.rows - 1.0);
  }
  return starts;
}

}  // namespace

LightFrame make_light_frame(const visibility::Light& light, float scale) {
  PENUMBRA_ASSERT(light.kind != visibility::LightKind::sphere, "a sphere has no plane");
  const Span span = span_of(light);
  LightFrame frame{glm::vec3(span.center) * scale, glm::vec3(span.u) * scale, glm::vec3(span.v) * scale, row_starts_of(light), {}, 0};
  double deviation = 0;
  for (std::size_t j = 0; j < light.points.size(); ++j) {
    const glm::dvec3 point = glm::dvec3(light.points[j]) * static_cast<double>(scale);
    glm::vec2 at;
    if (frame.row_starts.empty()) {
      at = coordinates_of(frame, point);
    } else {
      const glm::vec2 start = frame.row_starts[j / light.columns];
      at = {start.x + static_cast<float>(j % light.columns) * (2.0F / static_cast<float>(light.columns)), start.y};
    }
    frame.coordinates.push_back(at);
    const glm::dvec3 there = glm::dvec3(frame.center) + static_cast<double>(at.x) * glm::dvec3(frame.u) +
                             static_cast<double>(at.y) * glm::dvec3(frame.v);
    deviation = std::max(deviation, glm::length(point - there));
  }
  frame.deviation = std::nextafter(static_cast<float>(deviation * 1.0001), INFINITY);
  return frame;
}

}  // namespace penumbra::vsm
