#include "import/polygon.hpp"

#include "base/assert.hpp"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <cmath>
#include <numeric>

// Where a polygon that is neither flat nor simple is cut is a convention, not a fact of its geometry, so plain double
// arithmetic decides here; nothing later depends on these signs, and the number of triangles never does.

namespace penumbra::mesh {
namespace {

/// Newell's normal: the sum of the edges' cross products; its length is twice the area of a flat polygon.
glm::dvec3 mean_normal(std::span<const glm::dvec3> corners) {
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    sum += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  }
  return sum;
}

/// The corners seen along the axis that the mean normal is closest to, turned so that they run counter-clockwise.
std::vector<glm::dvec2> project(std::span<const glm::dvec3> corners) {
  const glm::dvec3 normal = mean_normal(corners);
  const glm::dvec3 size(std::abs(normal.x), std::abs(normal.y), std::abs(normal.z));
  const glm::length_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const glm::length_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::vector<glm::dvec2> flat;
  flat.reserve(corners.size());
  for (const glm::dvec3& corner : corners) {
    const glm::dvec3 p = corner - corners[0];
    flat.emplace_back(normal[axis] >= 0 ? glm::dvec2(p[u], p[v]) : glm::dvec2(p[v], p[u]));
  }
  return flat;
}

/// Twice the signed area of the triangle a b c: positive if it runs counter-clockwise.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// No corner turns right, and the outline goes round once: then every fan triangle lies inside.
bool is_convex(std::span<const glm::dvec2> outline) {
  const std::size_t count = outline.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (turn(outline[i], outline[(i + 1) % count], outline[(i + 2) % count]) < 0) return false;
  }
  // A pentagram turns left everywhere, too, but its fan turns right somewhere.
  for (std::size_t i = 1; i + 1 < count; ++i) {
    if (turn(outline[0], outline[i], outline[i + 1]) < 0) return false;
  }
  return true;
}

bool is_ear(std::span<const glm::dvec2> outline, std::span<const std::uint32_t> ring, std::size_t tip) {
  const std::size_t count = ring.size();
  const glm::dvec2 a = outline[ring[(tip + count - 1) % count]], b = outline[ring[tip]],
                   c = outline[ring[(tip + 1) % count]];
  if (turn(a, b, c) <= 0) return false;
  for (const std::uint32_t corner : ring) {
    const glm::dvec2 p = outline[corner];
    if (p == a || p == b || p == c) continue;  // also a bridge to a hole, which visits corners twice
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

}  // namespace

PolygonKind triangulate_polygon(std::span<const glm::dvec3> corners, std::vector<Triangle>& triangles) {
  PENUMBRA_ASSERT(corners.size() >= 3, "a polygon with {} corners", corners.size());
  std::vector<std::uint32_t> ring(corners.size());
  std::iota(ring.begin(), ring.end(), 0u);
  const auto fan = [&] {
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) triangles.push_back({ring[0], ring[i], ring[i + 1]});
  };
  if (corners.size() == 3) return fan(), PolygonKind::convex;
  const std::vector<glm::dvec2> outline = project(corners);
  if (is_convex(outline)) return fan(), PolygonKind::convex;

  std::size_t tip = 0, tries = 0;
  while (ring.size() > 3 && tries < ring.size()) {
    const std::size_t count = ring.size();
    if (!is_ear(outline, ring, tip)) {
      tip = (tip + 1) % count;
      ++tries;
      continue;
    }
    triangles.push_back({ring[(tip + count - 1) % count], ring[tip], ring[(tip + 1) % count]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(tip));
    tip %= ring.size();  // go on with the next corner, not around the same one: fewer slivers
    tries = 0;
  }
  const bool stuck = ring.size() > 3;
  fan();
  return stuck ? PolygonKind::tangled : PolygonKind::concave;
}

}  // namespace penumbra::mesh
