// SPDX-License-Identifier: Apache-2.0
// Polygon lights in files. The normal is the sum of the cross products of a fan. A polygon must have an area, be flat
// up to the rounding of single precision, and convex: no vertex lies outside of any edge.

#include "base/error.hpp"
#include "scenes/formats/checks.hpp"
#include "scenes/formats/json_meshes.hpp"
#include "scenes/formats/lights/light_formats.hpp"

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <variant>

namespace penumbra::scenes {

glm::dvec3 polygon_normal(const Polygon& polygon) {
  // Computed relative to the first vertex, so that a small polygon far from the origin keeps its precision.
  const std::vector<glm::dvec3>& vertices = polygon.vertices;
  glm::dvec3 sum(0);
  for (std::size_t i = 1; i + 1 < vertices.size(); ++i) {
    sum += glm::cross(vertices[i] - vertices[0], vertices[i + 1] - vertices[0]);
  }
  const double length = glm::length(sum);
  return length > 0 ? sum / length : sum;
}

namespace {

LightShape read_polygon(const nlohmann::json& corners) {
  Polygon polygon;
  for (const nlohmann::json& corner : corners) polygon.vertices.push_back(read_vector(corner));
  return polygon;
}

void write_polygon(const LightShape& shape, TextStream& text) {
  const std::vector<glm::dvec3>& vertices = std::get<Polygon>(shape).vertices;
  text.print("[");
  for (std::size_t i = 0; i < vertices.size(); ++i) text.print("{}", i > 0 ? ", " : "").array(vertices[i]);
  text.print("]");
}

void check_polygon(const LightShape& shape, const std::string& where) {
  const auto& polygon = std::get<Polygon>(shape);
  const std::vector<glm::dvec3>& vertices = polygon.vertices;
  const std::size_t count = vertices.size();
  if (count < 3) throw InputError("{}: a polygon light needs at least 3 vertices; found {}", where, count);
  double magnitude = 0, perimeter = 0;
  glm::dvec3 centroid(0);
  for (std::size_t i = 0; i < count; ++i) {
    check_position(vertices[i], where, fmt::format("vertex {}", i).c_str());
    const glm::dvec3& next = vertices[(i + 1) % count];
    if (vertices[i] == next) {
      throw InputError("{}: vertices {} and {} are the same point {}; remove one", where, i, (i + 1) % count,
                       show_vector(next));
    }
    magnitude = std::max({magnitude, std::abs(vertices[i].x), std::abs(vertices[i].y), std::abs(vertices[i].z)});
    perimeter += glm::distance(vertices[i], next);
    centroid += vertices[i] / static_cast<double>(count);
  }
  // Vertices of a flat polygon that was rotated and stored in single precision deviate by this much; larger deviations
  // are not rounding.
  const double tolerance = 16 * 0x1p-24 * magnitude;
  const glm::dvec3 normal = polygon_normal(polygon);
  double width = 0;  // approximate width across the longest direction: twice the area over the perimeter
  for (std::size_t i = 0; i < count; ++i) {
    width += glm::dot(normal, glm::cross(vertices[i] - centroid, vertices[(i + 1) % count] - centroid)) / perimeter;
  }
  if (!(width > std::numeric_limits<double>::epsilon() * magnitude))
    throw InputError("{}: the light has no area: its vertices lie on a line", where);
  for (std::size_t i = 0; i < count; ++i) {
    const double off = glm::dot(normal, vertices[i] - centroid);
    if (std::abs(off) > tolerance) {
      throw InputError("{}: the polygon is not flat: vertex {} {} lies {:.6g} off its plane", where, i,
                       show_vector(vertices[i]), std::abs(off));
    }
  }
  // Convex: no vertex lies to the right of any edge (the sum of turns alone would accept a pentagram).
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = (i + 1) % count;
    const glm::dvec3 inward = glm::normalize(glm::cross(normal, vertices[next] - vertices[i]));
    for (std::size_t j = 0; j < count; ++j) {
      const double off = -glm::dot(inward, vertices[j] - vertices[i]);
      if (off > tolerance) {
        throw InputError(
            "{}: the polygon is not convex: vertex {} {} lies {:.6g} outside the edge from vertex {} to {}", where, j,
            show_vector(vertices[j]), off, i, next);
      }
    }
  }
}

std::vector<glm::dvec3> polygon_outline(const LightShape& shape) {
  return std::get<Polygon>(shape).vertices;
}

}  // namespace

const LightFormat kPolygonFormat{
    .read = read_polygon, .write = write_polygon, .check = check_polygon, .outline = polygon_outline};

}  // namespace penumbra::scenes
