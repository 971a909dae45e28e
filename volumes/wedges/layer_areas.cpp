// SPDX-License-Identifier: Apache-2.0
// Computes the hidden part of a light triangle by triangle: projects each triangle to the light's plane, clips by
// Sutherland and Hodgman 1974, and sums areas. Used to check the sums over silhouettes.

#include "volumes/wedges/layer_areas.hpp"

#include "mesh/predicates.hpp"
#include "volumes/wedges/planar.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace penumbra::volumes {
namespace {

/// Returns the part of a convex polygon where `height`, an affine function, is not negative.
template <typename Point, typename Height, typename Mix>
std::vector<Point> cut(const std::vector<Point>& polygon, const Height& height, const Mix& mix) {
  std::vector<Point> left;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = height(a), at_b = height(b);
    if (at_a >= 0) left.push_back(a);
    if ((at_a >= 0) != (at_b >= 0)) left.push_back(mix(a, b, at_a / (at_a - at_b)));
  }
  return left;
}

/// Returns (X, Y, W) as in radial_coverage.hpp.
glm::dvec3 homogeneous(const Projected& q) {
  return {q.x, q.y, q.w};
}

/// Returns a convex, counter-clockwise polygon around the outline; for a disk, the square around the disk.
Polygon polygon_around(const LightOutline& outline) {
  return outline.corners.empty() ? Polygon{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}} : outline.corners;
}

/// Returns the signed area of the unit disk within the triangle (0, a, b): under the chord where the edge is inside,
/// and under the arc where the edge is outside.
double disk_triangle(const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 d = b - a;
  const auto arc = [](const glm::dvec2& from, const glm::dvec2& to) {
    return std::atan2(cross2(from, to), glm::dot(from, to)) / 2;
  };
  const double size = glm::dot(d, d), half = glm::dot(a, d), rest = glm::dot(a, a) - 1;
  const double discriminant = half * half - size * rest;
  if (!(discriminant > 0)) return arc(a, b);
  const double low = (-half - std::sqrt(discriminant)) / size, high = (-half + std::sqrt(discriminant)) / size;
  if (low >= 1 || high <= 0) return arc(a, b);
  const glm::dvec2 from = low > 0 ? a + low * d : a, to = high < 1 ? a + high * d : b;
  return (low > 0 ? arc(a, from) : 0) + cross2(from, to) / 2 + (high < 1 ? arc(to, b) : 0);
}

double area_within(const LightOutline& outline, const Polygon& polygon) {
  if (!outline.corners.empty()) return area_of(polygon);
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) sum += disk_triangle(polygon[i], polygon[(i + 1) % polygon.size()]);
  return sum;
}

const auto kMix = [](const auto& a, const auto& b, double t) { return a + t * (b - a); };

/// Sides shorter than this are skipped: rounding of the ends by 2⁻⁴⁸ turns a side by an angle that exceeds its length.
/// Skipping a side changes an area by no more than the side's length.
constexpr double kShortestSide = 0x1p-24;

/// Returns the intersection of two convex polygons: empty, or with positive area.
Polygon common_part(Polygon one, const Polygon& other) {
  for (std::size_t i = 0; i < other.size() && one.size() > 2; ++i) {
    const glm::dvec2 corner = other[i], side = other[(i + 1) % other.size()] - corner;
    if (glm::length(side) < kShortestSide) continue;
    one = cut(
        one, [&](const glm::dvec2& q) { return cross2(side, q - corner); }, kMix);
  }
  if (one.size() < 3) one.clear();
  return one;
}

/// Returns the distance from 0 to the nearest point of the triangle.
double distance_to(const std::array<glm::dvec3, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  const glm::dvec3 n = glm::cross(b - a, c - a);
  bool within = glm::dot(n, n) > 0;  // whether the nearest point of the plane is within the triangle
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 &from = triangle[i], direction = triangle[(i + 1) % 3] - from;
    within = within && glm::dot(glm::cross(direction, -from), n) >= 0;
    const double size = glm::dot(direction, direction),
                 share = size > 0 ? std::clamp(-glm::dot(from, direction) / size, 0.0, 1.0) : 0;
    nearest = std::min(nearest, glm::length(from + share * direction));
  }
  return within ? std::min(nearest, std::abs(glm::dot(n, a)) / glm::length(n)) : nearest;
}

constexpr double kHair = 0x1p-20;  ///< a fraction of the light: far above rounding, far below what is visible

struct Bounds {
  glm::dvec2 lower, upper;
};
Bounds bounds_of(const Polygon& polygon) {
  Bounds bounds{polygon.front(), polygon.front()};
  for (const glm::dvec2& q : polygon) bounds = {glm::min(bounds.lower, q), glm::max(bounds.upper, q)};
  return bounds;
}

}  // namespace

std::vector<Polygon> projected_layers(const visibility::Light& light, const glm::vec3& p,
                                      std::span<const std::array<glm::vec3, 3>> triangles) {
  const LightProjection projection(light, p);
  const Polygon whole = polygon_around(light_outline(light));
  std::vector<Polygon> layers;
  for (const std::array<glm::vec3, 3>& corners : triangles) {
    std::vector<glm::dvec3> seen;
    for (const glm::vec3& corner : corners) seen.push_back(homogeneous(projection(glm::dvec3(corner))));
    seen = cut(
        seen, [](const glm::dvec3& q) { return q.z; }, kMix);
    seen = cut(
        seen, [](const glm::dvec3& q) { return 1 - q.z; }, kMix);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const glm::dvec2 corner = whole[i], side = whole[(i + 1) % whole.size()] - corner;
      seen = cut(
          seen, [&](const glm::dvec3& q) { return cross2(side, glm::dvec2(q) - q.z * corner); }, kMix);
    }
    Polygon layer;
    for (const glm::dvec3& q : seen) {
      if (q.z > 0) layer.push_back(glm::dvec2(q) / q.z);
    }
    const double area = area_of(layer);
    if (area < 0) std::ranges::reverse(layer);
    if (area != 0) layers.push_back(std::move(layer));
  }
  return layers;
}

bool touches_light(const visibility::Light& light, const std::array<glm::vec3, 3>& triangle) {
  if (is_body(light.kind)) {
    const glm::dvec3 c = light.center;
    const auto& [p, q, r] = triangle;
    return distance_to({glm::dvec3(p) - c, glm::dvec3(q) - c, glm::dvec3(r) - c}) <= light.radius * (1 + kHair);
  }
  std::array<mesh::Side, 3> sides{};
  for (std::size_t i = 0; i < 3; ++i) {
    sides[i] = mesh::side_of_plane(light.center, light.center_u, light.center_v, triangle[i]);
  }
  if (sides[0] != mesh::Side::on && sides[0] == sides[1] && sides[0] == sides[2]) return false;
  const visibility::LightFrame frame = visibility::light_frame(light);
  const glm::dvec3 n = glm::cross(frame.u, frame.v);
  const auto in_frame = [&](const glm::dvec3& x) {
    return glm::dvec2(glm::dot(glm::cross(x - frame.center, frame.v), n),
                      glm::dot(glm::cross(frame.u, x - frame.center), n)) /
           glm::dot(n, n);
  };
  Polygon met;  // intersection of the triangle and the plane: a point, a segment or the triangle
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 a = triangle[i], b = triangle[(i + 1) % 3];
    const mesh::Side at_a = sides[i], at_b = sides[(i + 1) % 3];
    if (at_a == mesh::Side::on) met.push_back(in_frame(a));
    if (at_a == mesh::Side::on || at_b != mesh::opposite(at_a)) continue;
    const double from = std::abs(glm::dot(n, a - frame.center)), to = std::abs(glm::dot(n, b - frame.center));
    met.push_back(in_frame(a + (from + to > 0 ? from / (from + to) : 0.5) * (b - a)));
  }
  const Polygon whole = polygon_around(light_outline(light));
  for (std::size_t i = 0; i < whole.size() && !met.empty(); ++i) {
    const glm::dvec2 corner = whole[i], side = whole[(i + 1) % whole.size()] - corner;
    met = cut(
        met, [&](const glm::dvec2& q) { return cross2(side, q - corner) + kHair; }, kMix);
  }
  return !met.empty();
}

double sum_of_layers(const LightOutline& outline, std::span<const Polygon> layers, const TextureWeights* texture) {
  double sum = 0;
  for (const Polygon& layer : layers) {
    sum += texture != nullptr ? texture->weight_of(layer) : area_within(outline, layer) / outline.area;
  }
  return sum;
}

double overlap_of_layers(const LightOutline& outline, std::span<const Polygon> layers, double stop,
                         const TextureWeights* texture) {
  std::vector<Bounds> bounds;
  for (const Polygon& layer : layers) bounds.push_back(bounds_of(layer));
  std::vector<std::size_t> order(layers.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t i, std::size_t j) { return bounds[i].lower.x < bounds[j].lower.x; });
  double sum = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Bounds& one = bounds[order[i]];
    for (std::size_t j = i + 1; j < order.size() && bounds[order[j]].lower.x < one.upper.x; ++j) {
      const Bounds& other = bounds[order[j]];
      if (other.lower.y >= one.upper.y || other.upper.y <= one.lower.y) continue;
      const Polygon common = common_part(layers[order[i]], layers[order[j]]);
      sum += texture != nullptr ? texture->weight_of(common) : area_of(common) / outline.area;
    }
    if (sum > stop) return sum;
  }
  return sum;
}

}  // namespace penumbra::volumes
