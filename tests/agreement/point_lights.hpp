// SPDX-License-Identifier: Apache-2.0
#pragma once

// Lights whose samples form no rows of a rectangle.

#include "tests/unit/textured_lights_support.hpp"
#include "tests/unit/visibility/scenes.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <ostream>
#include <random>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace penumbra::tests {

enum class PointLight : std::uint8_t { disk, polygon, textured, sobol, jittered, grid, ellipse };
inline constexpr std::array kPointLights{PointLight::disk,   PointLight::polygon,  PointLight::textured,
                                         PointLight::sobol,  PointLight::jittered, PointLight::grid,
                                         PointLight::ellipse};
inline std::string name_of(PointLight kind) {
  static constexpr std::array kNames{"disk", "polygon", "textured", "sobol", "jittered", "grid", "ellipse"};
  return kNames.at(static_cast<std::size_t>(kind));
}
inline std::ostream& operator<<(std::ostream& out, PointLight kind) {
  return out << name_of(kind);
}

/// Returns convex polygons, counter-clockwise, with corners on a lattice: each light is an affine image of one.
inline const std::vector<std::vector<glm::dvec2>>& lattice_polygons() {
  static const std::vector<std::vector<glm::dvec2>> polygons{
      {{-1, -1}, {1, -1}, {0, 1}},
      {{-1, -1}, {1, -1}, {-1, 1}},
      {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}},
      {{-2, 0}, {0, -1}, {2, 0}, {0, 1}},
      {{-2, -1}, {1, -1}, {2, 0}, {2, 1}, {-1, 1}, {-2, 0}},
      {{-1, -2}, {1, -2}, {2, -1}, {2, 1}, {1, 2}, {-1, 2}, {-2, 1}, {-2, -1}}};
  return polygons;
}

/// Turns a rectangle light into one of the given kind, about as large and in its plane, and requests up to `most`
/// samples that form no rows of a rectangle.
inline void reshape(scenes::AreaLight& light, PointLight kind, visibility::SampleRequest& request, std::mt19937& random,
                    std::uint32_t most) {
  const auto below = [&](std::uint32_t end) { return static_cast<std::uint32_t>(random() % end); };
  const scenes::Rectangle shape = std::get<scenes::Rectangle>(light.shape);
  using Pattern = visibility::SamplePattern;
  static constexpr std::array kPatterns{Pattern::rows, Pattern::grid, Pattern::sobol, Pattern::jittered};
  request = {1 + below(most), 0, 0, kPatterns.at(below(4)), below(100)};
  switch (kind) {
    case PointLight::disk:
    case PointLight::grid:
      light.shape = scenes::Disk{shape.center, glm::normalize(glm::cross(shape.half_u, shape.half_v)),
                                 std::min(glm::length(shape.half_u), glm::length(shape.half_v))};
      if (kind == PointLight::grid) request.pattern = Pattern::grid;
      break;
    case PointLight::ellipse:
      light.shape = scenes::Ellipse{shape.center, shape.half_u, shape.half_v};
      break;
    case PointLight::polygon: {
      const std::vector<glm::dvec2>& corners = lattice_polygons().at(below(6));
      std::vector<glm::dvec3> vertices;
      for (const glm::dvec2& at : corners) vertices.push_back(shape.center + at.x * shape.half_u + at.y * shape.half_v);
      std::rotate(vertices.begin(), vertices.begin() + below(static_cast<std::uint32_t>(vertices.size())),
                  vertices.end());
      light.shape = scenes::Polygon{vertices};
      break;
    }
    case PointLight::textured:
      light.texture = texture_of(5, 3, [&](std::uint32_t x, std::uint32_t y) {
        return glm::vec3(x + y == 0 ? 1.0F : static_cast<float>(below(4)) / 3.0F);
      });
      request.pattern = below(2) == 0 ? Pattern::sobol : Pattern::jittered;
      request.count = std::max(request.count, 16U);  // enough that not all are on black texels
      break;
    case PointLight::sobol:
      request.pattern = Pattern::sobol;
      break;
    case PointLight::jittered:
      request.pattern = Pattern::jittered;
      break;
  }
}

}  // namespace penumbra::tests
