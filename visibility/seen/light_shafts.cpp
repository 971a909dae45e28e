// SPDX-License-Identifier: Apache-2.0
// Builds shafts from a box of points to a light (E. Haines and J. Wallace, Shaft culling for efficient ray-cast
// radiosity, 1991). Departures: the light is the hull of its corners, its sides are further planes, and all planes are
// moved outward by the rounding of stored points.

#include "visibility/seen/light_shafts.hpp"

#include "base/assert.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

namespace penumbra::visibility {
namespace {

/// Margin of a hull: stored light points are within this share of the largest coordinate, or of a direction's length,
/// of the hull of the stored corners (derivation: visibility/alpha/alpha_reach.cpp), doubled.
constexpr double kRoom = 0x1p-19;

/// A point in a projection along an axis.
struct Flat {
  double a, b;
};

/// Returns a value above 0 if the path from o over x to y turns left.
double turn(const Flat& o, const Flat& x, const Flat& y) {
  return (x.a - o.a) * (y.b - o.b) - (x.b - o.b) * (y.a - o.a);
}

/// Returns the hull's corners, counter-clockwise (Andrew 1979). Collinear corners may stay.
std::vector<Flat> convex_hull(std::vector<Flat> points) {
  std::ranges::sort(points, [](const Flat& x, const Flat& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
  const auto same = [](const Flat& x, const Flat& y) { return x.a == y.a && x.b == y.b; };
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
  if (points.size() < 3) return points;
  std::vector<Flat> hull(2 * points.size());
  std::size_t count = 0;
  const auto add = [&](const Flat& point, std::size_t least) {
    while (count >= least && turn(hull[count - 2], hull[count - 1], point) < 0) --count;
    hull[count++] = point;
  };
  for (const Flat& point : points) add(point, 2);
  const std::size_t lower = count + 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  hull.resize(count - 1);
  return hull;
}

}  // namespace

LightHull hull_of(std::span<const Light> pieces) {
  LightHull hull;
  double size = 0;
  for (const Light& light : pieces) {
    PENUMBRA_ASSERT(!light.dome, "light {}: segments to a dome have all directions", light.name);
    const glm::dvec3 center = light.center;
    if (light.sun) {
      const glm::dvec3 u = light.sun->tangent * glm::dvec3(light.sun->axis_u),
                       v = light.sun->tangent * glm::dvec3(light.sun->axis_v);
      hull.directions = true;
      hull.corners = {center - u - v, center + u - v, center + u + v, center - u + v};
      hull.in_order = true;
      size = 1 + light.sun->tangent;
    } else if (is_body(light.kind)) {
      // A square around the disk that a view sample sees has corners up to √2 radii from the middle.
      const double side = std::numbers::sqrt2 * light.radius;
      for (int corner = 0; corner < 8; ++corner) {
        hull.corners.push_back(center + side * glm::dvec3((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                                                          (corner & 4) != 0 ? 1 : -1));
      }
    } else {
      hull.corners.insert(hull.corners.end(), light.outline.begin(), light.outline.end());
      hull.in_order = pieces.size() == 1;
      if (!light.two_sided && pieces.size() == 1) {
        hull.front = {
            glm::normalize(glm::cross(glm::dvec3(light.center_u) - center, glm::dvec3(light.center_v) - center)),
            center};
      }
    }
  }
  for (const glm::dvec3& corner : hull.corners) size = std::max(size, sum_of_sides(corner));
  hull.room = kRoom * size;
  if (hull.corners.size() <= 8) return hull;
  hull.in_order = false;
  glm::dvec3 lower(hull.corners.front()), upper = lower;  // bounding box of all pieces
  for (const glm::dvec3& corner : hull.corners) lower = glm::min(lower, corner), upper = glm::max(upper, corner);
  hull.corners.clear();
  for (int corner = 0; corner < 8; ++corner) {
    hull.corners.emplace_back((corner & 1) != 0 ? upper.x : lower.x, (corner & 2) != 0 ? upper.y : lower.y,
                              (corner & 4) != 0 ? upper.z : lower.z);
  }
  return hull;
}

LightShaft::LightShaft(const glm::dvec3& lower, const glm::dvec3& upper, const LightHull& light, double reach) {
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 point((corner & 1) != 0 ? upper.x : lower.x, (corner & 2) != 0 ? upper.y : lower.y,
                           (corner & 4) != 0 ? upper.z : lower.z);
    corners_.push_back(point);
    if (!light.directions) continue;
    for (const glm::dvec3& direction : light.corners) corners_.push_back(point + 2 * reach * direction);
  }
  if (!light.directions) corners_.insert(corners_.end(), light.corners.begin(), light.corners.end());
  double size = 0;
  glm::dvec3 least = corners_.front(), greatest = least;
  for (const glm::dvec3& corner : corners_) {
    least = glm::min(least, corner), greatest = glm::max(greatest, corner);
    size = std::max(size, sum_of_sides(corner));
  }
  room_ = (light.directions ? 2 * reach * light.room : light.room) +
          kRoom * sum_of_sides(glm::max(glm::abs(lower), glm::abs(upper))) + 0x1p-46 * size;
  around_ = {0.5 * (least + greatest), 0.5 * (greatest - least) + room_};
  for (int axis = 0; axis < 3; ++axis) add_planes_along(axis);
  if (!light.in_order) return;
  const glm::dvec3 middle = 0.5 * (lower + upper);
  glm::dvec3 inside(0);
  for (const glm::dvec3& corner : light.corners) inside += light.directions ? corner : corner - middle;
  for (std::size_t i = 0; i < light.corners.size(); ++i) {
    const glm::dvec3 &one = light.corners[i], &other = light.corners[(i + 1) % light.corners.size()];
    const glm::dvec3 normal = light.directions ? glm::cross(one, other) : glm::cross(one - middle, other - middle);
    add_plane(glm::dot(normal, inside) > 0 ? -normal : normal);
  }
}

/// Moves the plane out to the farthest corner, so that it is valid whatever the rounding of the normal.
void LightShaft::add_plane(const glm::dvec3& normal) {
  double most = -std::numeric_limits<double>::infinity();
  for (const glm::dvec3& corner : corners_) most = std::max(most, glm::dot(normal, corner));
  planes_.push_back({normal, most + sum_of_sides(normal) * room_});
}

void LightShaft::add_planes_along(int axis) {
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  std::vector<Flat> points;
  for (const glm::dvec3& corner : corners_) points.push_back({corner[a], corner[b]});
  const std::vector<Flat> hull = convex_hull(std::move(points));
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Flat &from = hull[i], &to = hull[i + 1 < hull.size() ? i + 1 : 0];
    glm::dvec3 normal(0);
    normal[a] = to.b - from.b, normal[b] = from.a - to.a;     // outward
    if (normal[a] != 0 && normal[b] != 0) add_plane(normal);  // other planes are sides of the common bounding box
  }
}

bool LightShaft::is_around(const MiddleBox& box) const {
  const glm::dvec3 apart = glm::abs(box.middle - around_.middle), reach = box.half + around_.half;
  return apart.x <= reach.x && apart.y <= reach.y && apart.z <= reach.z;
}

bool LightShaft::touches(const MiddleBox& box) const {
  return is_around(box) && std::ranges::none_of(planes_, [&](const Plane& plane) {
           return glm::dot(plane.normal, box.middle) - glm::dot(glm::abs(plane.normal), box.half) > plane.most;
         });
}

ShaftOfPart::ShaftOfPart(const LightShaft& shaft, const PlacedMeshes::Part& part) : part_(part) {
  const MiddleBox& root = part.tree->root().box;
  shaft.for_each_plane([&](const LightShaft::Plane& plane) {
    if (misses_) return;
    const glm::dvec3 normal = plane.normal * part.linear;
    // Twice the part's room: for its corners, and for the rounding of the plane, which is less than theirs.
    const double most = plane.most - glm::dot(plane.normal, part.offset) + 2 * part.room * sum_of_sides(plane.normal);
    const double middle = glm::dot(normal, root.middle), half = glm::dot(glm::abs(normal), root.half);
    misses_ = middle - half > most;
    if (middle + half > most) planes_.add(normal, most);
  });
}

}  // namespace penumbra::visibility
