// SPDX-License-Identifier: Apache-2.0
// Divides planar lights into parts (Yang et al. 2009, section 5) by a grid over their bounding rectangle.

#include "visibility/lights/light_parts.hpp"

#include "visibility/lights/convex_polygon.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>

namespace penumbra::visibility {
namespace {

/// Returns the length of [from, to] covered by texel k of n, where all texels cover [0, 1].
double overlap(double from, double to, std::uint32_t k, std::uint32_t n) {
  return std::max(0.0, std::min(to, (k + 1.0) / n) - std::max(from, static_cast<double>(k) / n));
}

/// Returns the integral of the texture's luminance over a part, in the light's coordinates scaled to [0, 1]².
double luminance_in(const LightTexture& texture, const glm::dvec2& lower, const glm::dvec2& upper) {
  double sum = 0;
  for (std::uint32_t y = 0; y < texture.height; ++y) {
    // Rows run from the top downward.
    const double high = overlap(lower.y, upper.y, texture.height - 1 - y, texture.height);
    for (std::uint32_t x = 0; high > 0 && x < texture.width; ++x) {
      sum += texture.luminance[std::size_t{y} * texture.width + x] * high * overlap(lower.x, upper.x, x, texture.width);
    }
  }
  return sum;
}

/// Returns the texture of a part; nullopt if it is constant.
std::optional<LightTexture> texture_of_part(const LightTexture& whole, std::uint32_t count, const glm::uvec2& part) {
  LightTexture texture = texture_part(whole, count, part);
  if (std::ranges::adjacent_find(texture.luminance, std::not_equal_to<>()) == texture.luminance.end())
    return std::nullopt;
  return texture;
}

/// Returns the light's outline in its frame's coordinates.
std::vector<glm::dvec2> outline_of(const Light& light, const LightFrame& frame) {
  std::vector<glm::dvec2> outline;
  if (is_round(light.kind)) {
    constexpr int kSides = 256;
    constexpr double kStep = 2 * std::numbers::pi / kSides;
    const double reach = std::sqrt(kStep / std::sin(kStep));  // ½ m reach² sin(2π/m) = π
    for (int i = 0; i < kSides; ++i) {
      outline.emplace_back(reach * std::cos(kStep * (i + 0.5)), reach * std::sin(kStep * (i + 0.5)));
    }
    return outline;
  }
  const double uu = glm::dot(frame.u, frame.u), uv = glm::dot(frame.u, frame.v), vv = glm::dot(frame.v, frame.v);
  const double determinant = uu * vv - uv * uv;
  for (const glm::vec3& corner : light.outline) {
    const glm::dvec3 d = glm::dvec3(corner) - frame.center;
    const double du = glm::dot(d, frame.u), dv = glm::dot(d, frame.v);
    outline.emplace_back((du * vv - dv * uv) / determinant, (dv * uu - du * uv) / determinant);
  }
  return outline;
}

/// Returns a polygon light. `corners` in frame coordinates, counter-clockwise as seen from the emitting side.
Light polygon_of(const Light& light, const LightFrame& frame, const std::vector<glm::dvec2>& corners) {
  Light part = light;
  part.kind = LightKind::polygon;
  part.radius = 0;
  part.area = area_of(corners) * glm::length(glm::cross(frame.u, frame.v));
  part.outline.clear();
  for (const glm::dvec2& at : corners) part.outline.emplace_back(frame.center + at.x * frame.u + at.y * frame.v);
  // Chooses the frame's three corners: those that span the largest triangle.
  glm::vec3 best{0};
  double most = -1;
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const glm::dvec2 b = corners[i] - corners[0], c = corners[i + 1] - corners[0];
    const double twice = std::abs(b.x * c.y - b.y * c.x);
    if (twice <= most) continue;
    most = twice;
    part.center_u = part.outline[i];
    best = part.outline[i + 1];
  }
  part.center = part.outline.front();
  part.center_v = best;
  std::ranges::fill(part.points, center_of(part));
  return part;
}

std::vector<LightPart> polygon_parts(const Light& light, std::uint32_t count) {
  const LightFrame frame = light_frame(light);
  const std::vector<glm::dvec2> outline = outline_of(light, frame);
  glm::dvec2 lower(outline.front()), upper(outline.front());
  for (const glm::dvec2& corner : outline) {
    lower = glm::min(lower, corner);
    upper = glm::max(upper, corner);
  }
  const glm::dvec2 cell = (upper - lower) / static_cast<double>(count);
  std::vector<LightPart> parts;
  for (std::uint32_t row = 0; row < count; ++row) {
    for (std::uint32_t column = 0; column < count; ++column) {
      std::vector<glm::dvec2> corners = outline;
      for (const int axis : {0, 1}) {
        const double from = lower[axis] + cell[axis] * (axis == 0 ? column : row);
        corners = clipped_above(clipped_below(corners, axis, from), axis, from + cell[axis]);
      }
      const double area = corners.size() < 3 ? 0 : area_of(corners);
      if (area <= 0x1p-20 * cell.x * cell.y) continue;
      parts.push_back({polygon_of(light, frame, corners), area});
    }
  }
  return parts;
}

std::vector<LightPart> rectangle_parts(const Light& light, std::uint32_t count) {
  const LightFrame frame = light_frame(light);
  const glm::dvec3 u = frame.u / static_cast<double>(count), v = frame.v / static_cast<double>(count);
  std::vector<LightPart> parts;
  for (std::uint32_t row = 0; row < count; ++row) {
    for (std::uint32_t column = 0; column < count; ++column) {
      const glm::dvec2 lower = glm::dvec2(column, row) / static_cast<double>(count),
                       upper = glm::dvec2(column + 1, row + 1) / static_cast<double>(count);
      const double weight = light.texture ? luminance_in(*light.texture, lower, upper) : 1;
      if (weight == 0) continue;
      const glm::dvec3 center = frame.center + (2.0 * column + 1.0 - count) * u + (2.0 * row + 1.0 - count) * v;
      LightPart& part = parts.emplace_back(LightPart{light, weight});
      part.light.texture = std::nullopt;
      if (light.texture) part.light.texture = texture_of_part(*light.texture, count, {column, row});
      part.light.weights.clear();
      part.light.sample_colors.clear();
      part.light.area = light.area / (static_cast<double>(count) * count);
      part.light.center = center;
      part.light.center_u = center + u;
      part.light.center_v = center + v;
      part.light.outline = {center - u - v, center + u - v, center + u + v, center - u + v};
      for (std::size_t i = 0; i < light.points.size(); ++i) {
        part.light.points[i] = center + light.coordinates[i].x * u + light.coordinates[i].y * v;
      }
    }
  }
  return parts;
}

}  // namespace

LightTexture texture_part(const LightTexture& texture, std::uint32_t n, const glm::uvec2& part) {
  LightTexture result{texture.width, texture.height, {}, {}, 0};
  // Rows run from the top, parts from the bottom.
  const std::uint32_t from_top = n - 1 - part.y;
  for (std::uint32_t y = 0; y < texture.height; ++y) {
    for (std::uint32_t x = 0; x < texture.width; ++x) {
      const std::size_t texel =
          std::size_t{(from_top * texture.height + y) / n} * texture.width + (part.x * texture.width + x) / n;
      result.colors.push_back(texture.colors[texel]);
      result.luminance.push_back(texture.luminance[texel]);
      result.mean_luminance += texture.luminance[texel];
    }
  }
  result.mean_luminance /= static_cast<double>(result.luminance.size());
  return result;
}

std::vector<LightPart> light_parts(const Light& light, std::uint32_t count) {
  if (count == 1) return {{light, 1}};
  require_kind(light, kPlanarLights, ", which has no plane in which it could be divided; take sublights=1");
  std::vector<LightPart> parts =
      is_parallelogram(light.kind) ? rectangle_parts(light, count) : polygon_parts(light, count);
  const double sum = std::accumulate(parts.begin(), parts.end(), 0.0,
                                     [](double so_far, const LightPart& part) { return so_far + part.weight; });
  for (LightPart& part : parts) part.weight /= sum;
  return parts;
}

}  // namespace penumbra::visibility
