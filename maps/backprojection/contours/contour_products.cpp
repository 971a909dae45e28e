// SPDX-License-Identifier: Apache-2.0
// Converts a planar light to the form used for clipping contours, and uploads it.

#include "maps/backprojection/contours/contour_products.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/mat2x2.hpp>

#include <algorithm>
#include <span>

namespace penumbra::maps {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// Sets the rows that express a vector in the basis's plane as multiples of the axes u and v.
void set_to_unit(gpu::ContourLight& head, const glm::dvec2& u, const glm::dvec2& v) {
  const glm::dmat2 rows = glm::transpose(glm::inverse(glm::dmat2(u, v)));
  head.to_unit_x = rows[0];
  head.to_unit_y = rows[1];
}

/// Returns the table of a texture, in groups of three numbers, padded with zeros.
std::vector<glm::vec3> texture_table(const visibility::LightTexture& texture) {
  const std::size_t width = texture.width, height = texture.height;
  const double whole = texture.mean_luminance * static_cast<double>(width * height);
  std::vector<glm::vec3> table(((width + 1) * height + height + 1 + 2) / 3, glm::vec3(0));
  const auto set = [&](std::size_t at, double sum) {
    table[at / 3][static_cast<glm::length_t>(at % 3)] = static_cast<float>(sum / whole);
  };
  double below = 0;
  for (std::size_t y = 0; y < height; ++y) {
    double left = 0;
    for (std::size_t x = 0; x < width; ++x) {
      left += texture.luminance[(height - 1 - y) * width + x];  // rows of a texture run from the top downward
      set(y * (width + 1) + x + 1, left);
    }
    below += left;
    set((width + 1) * height + y + 1, below);
  }
  return table;
}

}  // namespace

ContourLightData contour_light(const visibility::Light& light, const LightBasis& basis) {
  ContourLightData data{};
  const LightBounds bounds = light_bounds(light, basis);
  data.head.lower = bounds.lower;
  data.head.upper = bounds.upper;
  if (is_circle(light.kind)) {
    data.head.disk = 1;
    set_to_unit(data.head, {light.radius, 0}, {0, light.radius});
    return data;
  }
  if (is_round(light.kind)) {
    const LightAxes axes = light_axes(light, basis);
    data.head.disk = 1;
    set_to_unit(data.head, axes.u, axes.v);
    return data;
  }
  if (is_parallelogram(light.kind)) {
    const visibility::LightFrame frame = visibility::light_frame(light);
    const glm::dvec3 u = basis.local(basis.center + frame.u), v = basis.local(basis.center + frame.v);
    set_to_unit(data.head, glm::dvec2(u), glm::dvec2(v));
    if (light.texture) {
      data.head.texture_width = light.texture->width;
      data.head.texture_height = light.texture->height;
      data.corners = texture_table(*light.texture);
    }
    return data;
  }
  std::vector<glm::dvec2> outline = light_outline(light, basis);
  double twice = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) twice += cross(outline[i], outline[(i + 1) % outline.size()]);
  if (twice < 0) std::reverse(outline.begin(), outline.end());
  twice = std::abs(twice);
  double swept = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    data.corners.emplace_back(outline[i], swept / twice);
    swept += cross(outline[i], outline[(i + 1) % outline.size()]);
  }
  data.head.corners = static_cast<std::uint32_t>(outline.size());
  data.head.inverse_area = static_cast<float>(2 / twice);
  return data;
}

void ContourLightProduct::record(render::Commands& /*commands*/, const MapSet& maps) {
  const ContourLightData data = contour_light(maps.light, maps.basis);
  render::grow(*device_, light_, "contour light", sizeof(data.head) + (data.corners.size() + 1) * sizeof(glm::vec3));
  light_->write<gpu::ContourLight>(std::span(&data.head, 1));
  if (!data.corners.empty()) light_->write<glm::vec3>(data.corners, sizeof(data.head));
}

}  // namespace penumbra::maps
