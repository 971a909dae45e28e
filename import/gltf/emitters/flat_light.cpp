// SPDX-License-Identifier: Apache-2.0
// Recognises flat convex emissive meshes as rectangle or polygon lights, within a given rounding of positions.

#include "import/gltf/emitters/flat_light.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace penumbra::import {
namespace {

/// Returns the edges that have a triangle on one side only, joined into one loop; nullopt if they do not form exactly
/// one.
std::optional<std::vector<std::uint32_t>> outline_of(const Welded& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const mesh::Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!edges.emplace(t[i], t[(i + 1) % 3]).second) return std::nullopt;  // two triangles on the same side
    }
  }
  std::map<std::uint32_t, std::uint32_t> next;
  for (const auto& [from, to] : edges) {
    if (edges.contains({to, from})) continue;
    if (!next.emplace(from, to).second) return std::nullopt;  // the outline touches itself
  }
  if (next.empty()) return std::nullopt;
  std::vector<std::uint32_t> loop;
  for (std::uint32_t at = next.begin()->first;;) {
    loop.push_back(at);
    const auto step = next.find(at);
    if (step == next.end() || loop.size() > next.size()) return std::nullopt;
    at = step->second;
    if (at == loop.front()) break;
  }
  if (loop.size() != next.size()) return std::nullopt;  // several loops: a hole, or separate pieces
  return loop;
}

/// Drops corners that lie on the line between their neighbours, up to the rounding.
std::vector<glm::dvec3> true_corners(std::vector<glm::dvec3> loop, double rounding) {
  for (std::size_t i = 0; i < loop.size() && loop.size() > 3;) {
    const std::size_t count = loop.size();
    const glm::dvec3 &before = loop[(i + count - 1) % count], &after = loop[(i + 1) % count];
    const glm::dvec3 along = after - before;
    const double height = glm::length(glm::cross(along, loop[i] - before));  // height times the base's length
    if (height <= 4 * rounding * glm::length(along)) {
      loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(i));
      i = 0;
    } else {
      ++i;
    }
  }
  return loop;
}

bool is_convex(std::span<const glm::dvec3> loop, const glm::dvec3& normal) {
  const std::size_t count = loop.size();
  const auto turn = [&](std::size_t a, std::size_t b, std::size_t c) {
    return glm::dot(normal, glm::cross(loop[b % count] - loop[a % count], loop[c % count] - loop[a % count]));
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (turn(i, i + 1, i + 2) <= 0) return false;
  }
  for (std::size_t i = 1; i + 1 < count; ++i) {  // also checks that the outline goes around only once
    if (turn(0, i, i + 1) <= 0) return false;
  }
  return true;
}

}  // namespace

FlatLight light_of_outline(std::vector<glm::dvec3> corners, const glm::dvec3& normal, double rounding) {
  corners = true_corners(std::move(corners), rounding);
  if (!is_convex(corners, normal)) return "its outline is not convex";
  if (corners.size() == 4) {
    const glm::dvec3 &a = corners[0], &b = corners[1], &c = corners[2], &d = corners[3];
    const glm::dvec3 half_u = ((b - a) + (c - d)) / 4.0, half_v = ((d - a) + (c - b)) / 4.0;
    const bool parallelogram = glm::length(a - b + c - d) <= 4 * rounding;
    // Each half side is off by at most the rounding, so their dot product is off by at most this.
    const bool right_angled =
        std::abs(glm::dot(half_u, half_v)) <= 2 * rounding * (glm::length(half_u) + glm::length(half_v));
    if (parallelogram && right_angled) return scenes::Rectangle{(a + b + c + d) / 4.0, half_u, half_v};
  }
  return scenes::Polygon{std::move(corners)};
}

FlatLight recognise_flat_light(const Welded& mesh, double rounding) {
  glm::dvec3 area(0);  // twice the vector area
  double total = 0;
  for (const mesh::Triangle& t : mesh.triangles) {
    const glm::dvec3 part = glm::cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]);
    area += part;
    total += glm::length(part);
  }
  if (!(total > 0)) return "it has no area";
  if (!(glm::length(area) > 0)) return "it is closed or its triangles are wound both ways";
  const glm::dvec3 normal = glm::normalize(area);
  glm::dvec3 center(0);
  for (const glm::dvec3& p : mesh.points) center += p / static_cast<double>(mesh.points.size());
  // Each position is off by the rounding along the normal, and so are the points that define the plane.
  for (const glm::dvec3& p : mesh.points) {
    if (std::abs(glm::dot(normal, p - center)) > 4 * rounding) return "it is not flat";
  }
  for (const mesh::Triangle& t : mesh.triangles) {
    const glm::dvec3 part = glm::cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]);
    const double longest = std::max(glm::distance(mesh.points[t[0]], mesh.points[t[1]]),
                                    glm::distance(mesh.points[t[0]], mesh.points[t[2]]));
    if (glm::dot(part, normal) < -4 * rounding * longest) return "its triangles are wound both ways";
  }
  const auto loop = outline_of(mesh);
  if (!loop) return "its triangles do not form one piece with a single outline and without holes";
  std::vector<glm::dvec3> corners;
  for (const std::uint32_t point : *loop) corners.push_back(mesh.points[point]);
  return light_of_outline(std::move(corners), normal, rounding);
}

}  // namespace penumbra::import
