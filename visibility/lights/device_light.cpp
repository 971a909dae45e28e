// SPDX-License-Identifier: Apache-2.0
// Planar lights in the float32 frame of device passes, with bounds on the distance of their stored samples.

#include "visibility/lights/device_light.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "visibility/tree/tree_texels.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace penumbra::visibility {
namespace {

/// A rectangle in the light's plane, in double, unscaled: the rectangle light itself, or a rectangle around any other
/// planar light.
struct Span {
  glm::dvec3 center, u, v;
};

Span span_of(const Light& light) {
  const auto [center, to_u, to_v] = light_frame(light);
  if (is_parallelogram(light.kind)) return {center, to_u, to_v};
  const glm::dvec3 axis_u = glm::normalize(to_u);
  const glm::dvec3 axis_v = glm::normalize(glm::cross(glm::cross(to_u, to_v), axis_u));
  glm::dvec2 lower(0), upper(0);
  const auto include = [&, &center = center](const glm::vec3& point) {  // clang 14 cannot capture structured bindings
    const glm::dvec2 at(glm::dot(glm::dvec3(point) - center, axis_u), glm::dot(glm::dvec3(point) - center, axis_v));
    lower = glm::min(lower, at);
    upper = glm::max(upper, at);
  };
  for (const glm::vec3& corner : light.outline) include(corner);
  for (const glm::vec3& point : light.points) include(point);
  const glm::dvec2 middle = 0.5 * (lower + upper), half = 0.5 * (upper - lower);
  return {center + middle.x * axis_u + middle.y * axis_v, half.x * axis_u, half.y * axis_v};
}

/// Returns (s, t) of one stored point in the rounded frame. u and v are nearly orthogonal, but this is not required.
glm::vec2 coordinates_of(const DeviceLight& frame, const glm::dvec3& point) {
  const glm::dvec3 u(frame.u), v(frame.v), at = point - glm::dvec3(frame.center);
  const double uu = glm::dot(u, u), vv = glm::dot(v, v), uv = glm::dot(u, v), det = uu * vv - uv * uv;
  const double along_u = glm::dot(at, u), along_v = glm::dot(at, v);
  const glm::dvec2 exact((along_u * vv - along_v * uv) / det, (along_v * uu - along_u * uv) / det);
  return glm::vec2(glm::clamp(exact, glm::dvec2(-1), glm::dvec2(1)));
}

/// Returns the smaller half-size of a light, and its reach from the scene's origin.
LightSpan sizes_of(const DeviceLight& frame) {
  const auto size = [](const glm::vec3& x) { return std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}); };
  return {std::min(size(frame.u), size(frame.v)), size(frame.center) + size(frame.u) + size(frame.v)};
}

bool holds(const LightSpan& span, const LightSpan& light) {
  return light.farthest <= span.farthest && light.smallest >= span.smallest;
}

constexpr std::uint32_t kShiftUnit = 65536;

double shift_of(std::uint32_t row, std::uint32_t step) {
  constexpr double kHalf = kShiftUnit / 2.0;
  return (static_cast<double>((row * step + kShiftUnit / 2) % kShiftUnit) - kHalf) / kShiftUnit;
}

/// Returns the step that gives the light's row shifts, if the samples form rows with such a step.
std::optional<std::uint32_t> shift_step_of(const Light& light) {
  if (!is_parallelogram(light.kind) || light.rows == 0) return std::nullopt;
  if (light.row_shift.size() < 2) return 0;
  const double step = light.row_shift[1] * kShiftUnit;
  const auto whole = static_cast<std::uint32_t>(static_cast<std::int64_t>(step)) % kShiftUnit;
  for (std::uint32_t row = 0; row < light.rows; ++row) {
    if (light.row_shift[row] != shift_of(row, whole)) return std::nullopt;
  }
  return whole;
}

}  // namespace

DeviceLight make_device_light(const Light& light, float scale) {
  PENUMBRA_ASSERT(!is_body(light.kind), "a {} has no plane", name_of(light.kind));
  const Span span = span_of(light);
  DeviceLight frame{
      glm::vec3(span.center) * scale, glm::vec3(span.u) * scale, glm::vec3(span.v) * scale, false, 0, {}, 0};
  const std::optional<std::uint32_t> step = shift_step_of(light);
  frame.rows = step.has_value();
  frame.shift_step = step.value_or(0);
  double deviation = 0;
  for (std::size_t j = 0; j < light.points.size(); ++j) {
    const glm::dvec3 point = glm::dvec3(light.points[j]) * static_cast<double>(scale);
    glm::vec2 at = coordinates_of(frame, point);
    if (frame.rows) {
      const auto row = static_cast<std::uint32_t>(j / light.columns),
                 column = static_cast<std::uint32_t>(j % light.columns);
      at = glm::vec2(2.0 * (column + 0.5 + shift_of(row, frame.shift_step)) / light.columns - 1.0,
                     2.0 * (row + 0.5) / light.rows - 1.0);
    }
    frame.coordinates.push_back(at);
    const glm::dvec3 there = glm::dvec3(frame.center) + static_cast<double>(at.x) * glm::dvec3(frame.u) +
                             static_cast<double>(at.y) * glm::dvec3(frame.v);
    deviation = std::max(deviation, glm::length(point - there));
  }
  // Devices compute (s, t) of rows in float: a few roundings of numbers up to 2.
  deviation += 0x1p-20 * (glm::length(glm::dvec3(frame.u)) + glm::length(glm::dvec3(frame.v)));
  frame.deviation = static_cast<float>(deviation * 1.0001);
  return frame;
}

bool has_rows(const Light& light) {
  return shift_step_of(light).has_value();
}

float reach_of(const SceneFloats& scene, const DeviceLight& frame, float scale) {
  float reach = 0;
  for (int i = 0; i < 3; ++i) {
    reach = std::max({reach, std::abs(frame.center[i]) + std::abs(frame.u[i]) + std::abs(frame.v[i]),
                      std::abs(scene.lower[i]) * scale, std::abs(scene.upper[i]) * scale});
  }
  return reach;
}

DeviceLight box_of_sphere(const Light& light, float scale) {
  const float radius = static_cast<float>(light.radius) * scale;
  DeviceLight box;
  box.center = light.center * scale;
  box.u = {radius, 0, 0};
  box.v = {0, radius, 0};
  return box;
}

bool can_span(const LightSpan& span, const Light& light, const SceneFloats& scene) {
  if (light.sun) return true;
  const float scale = device_scale(scene);
  return holds(span, sizes_of(is_body(light.kind) ? box_of_sphere(light, scale) : make_device_light(light, scale)));
}

void check_size(const Light& light, const DeviceLight& frame, const std::string& method) {
  const LightSpan sizes = sizes_of(frame);
  if (holds(kFloatSpan, sizes)) return;
  throw InputError(
      "light \"{}\": {} handles lights between 2^-28 and 2^28 of the scene's size; this one has half-size {:.3g} and "
      "reaches {:.3g} from the origin of a scene of size 1; use exact or raytrace, or bring light and scene closer in "
      "scale",
      light.name, method, sizes.smallest, sizes.farthest);
}

}  // namespace penumbra::visibility
