// SPDX-License-Identifier: Apache-2.0
// Cuts wedges by a box, and bodies by a horizontal plane, for viewing.

#include "volumes/wedges/wedge_body.hpp"

#include "volumes/wedges/planar.hpp"
#include "volumes/wedges/wedge_polyhedron.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace penumbra::volumes {
namespace {

bool is_finite(const Wedge& wedge) {
  return std::ranges::all_of(wedge.planes, [](const Plane& p) { return std::isfinite(p.a + p.b + p.c + p.d); });
}

}  // namespace

WedgeBody wedge_body(const Wedge& wedge, const Box& box) {
  WedgeBody body;
  if (wedge.outcome != WedgeOutcome::wedge || !is_finite(wedge)) return body;
  const Polyhedron polyhedron = cut_box(box, wedge.planes);
  if (polyhedron.faces.empty()) return body;
  for (const ExactPoint& corner : polyhedron.corners) body.corners.push_back(corner.near);
  for (const PolyhedronFace& face : polyhedron.faces) {
    const std::vector<std::uint32_t>& loop = face.loop;
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) body.triangles.push_back({loop[0], loop[i], loop[i + 1]});
    for (std::size_t i = 0; i < loop.size(); ++i) {  // the neighbour has this edge in the opposite direction
      const std::uint32_t from = loop[i], to = loop[(i + 1) % loop.size()];
      if (from < to) body.edges.push_back({from, to});
    }
  }
  return body;
}

std::vector<glm::dvec3> section_at(const WedgeBody& body, double height) {
  Polygon points;  // z and x, so that the order is counter-clockwise as seen from +y
  for (const glm::dvec3& corner : body.corners) {
    if (corner.y == height) points.emplace_back(corner.z, corner.x);
  }
  for (const auto& [from, to] : body.edges) {
    const glm::dvec3 &a = body.corners[from], &b = body.corners[to];
    if ((a.y < height) == (b.y < height) || a.y == height || b.y == height) continue;
    const glm::dvec3 point = a + (height - a.y) / (b.y - a.y) * (b - a);
    points.emplace_back(point.z, point.x);
  }
  std::vector<glm::dvec3> corners;
  const Polygon hull = hull_of(std::move(points));
  if (hull.size() < 3) return corners;
  for (const glm::dvec2& corner : hull) corners.emplace_back(corner.y, height, corner.x);
  return corners;
}

std::vector<mesh::Triangle> hull_triangles(const LightHull& light) {
  std::vector<mesh::Triangle> triangles;
  const auto count = static_cast<std::uint32_t>(light.corners.size());
  const auto volume = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k, std::uint32_t l) {
    const auto& c = light.corners;
    return glm::dot(glm::cross(c[j] - c[i], c[k] - c[i]), c[l] - c[i]);
  };
  // Tries all planes through three corners of a solid.
  for (std::uint32_t i = 0; light.is_solid && i < count; ++i) {
    for (std::uint32_t j = i + 1; j < count; ++j) {
      for (std::uint32_t k = i + 1; k < count; ++k) {
        bool outermost = k != j;
        for (std::uint32_t l = 0; l < count && outermost; ++l) {
          outermost = l == i || l == j || l == k || volume(i, j, k, l) < 0;
        }
        if (outermost) triangles.push_back({i, j, k});
      }
    }
  }
  for (std::uint32_t i = 1; !light.is_solid && i + 1 < count; ++i) triangles.push_back({0, i, i + 1});
  return triangles;
}

}  // namespace penumbra::volumes
