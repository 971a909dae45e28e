// SPDX-License-Identifier: Apache-2.0
// Screen boxes of volumes' faces. Clips in homogeneous coordinates (I. Sutherland, G. Hodgman, Reentrant polygon
// clipping, 1974), so that points at infinity and faces that contain the eye are no special cases; then takes the
// smallest of the rectangles that have an edge along one of the polygon's.

#include "volumes/raster/screen_box.hpp"

#include "base/error.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstddef>
#include <limits>

namespace penumbra::volumes {
namespace {

/// Callers may rely on an eighth of a pixel. The rest is for the rasteriser: corners snap to a grid of at least 2⁴
/// places per pixel (Vulkan's minimum of subPixelPrecisionBits), so move by up to √2/32 = 0.045, and are floats, off by
/// less than 0.01 in pictures up to 2¹⁵ pixels wide.
constexpr double kBoxPad = 0.25;

/// x and y in units of w, which is the distance along the view axis (for a direction: its component along the axis).
struct SeenPolygon {
  std::array<glm::dvec3, 8> corners;
  std::size_t size = 0;
  void add(const glm::dvec3& corner) { corners[size++] = corner; }
};

/// Returns the part where `limit` · w + `sign` · corner[axis] ≥ 0. Each plane adds at most one corner.
SeenPolygon cut_to_side(const SeenPolygon& polygon, int axis, double sign, double limit) {
  const auto inside = [&](const glm::dvec3& v) { return limit * v.z + sign * v[axis]; };
  SeenPolygon out;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const glm::dvec3 &from = polygon.corners[i], &to = polygon.corners[(i + 1) % polygon.size];
    const double d = inside(from), e = inside(to);
    if (d >= 0) out.add(from);
    if ((d < 0 && e > 0) || (d > 0 && e < 0)) out.add(from + (to - from) * (d / (d - e)));
  }
  return out;
}

struct SeenCorners {
  std::array<glm::dvec2, 8> at;
  std::size_t size = 0;
};

ScreenBox box_along(const SeenCorners& points, const glm::dvec2& u, double& area) {
  const glm::dvec2 v(-u.y, u.x);
  glm::dvec2 lower(std::numeric_limits<double>::infinity()), upper = -lower;
  for (std::size_t i = 0; i < points.size; ++i) {
    const glm::dvec2 q(glm::dot(points.at[i], u), glm::dot(points.at[i], v));
    lower = glm::min(lower, q);
    upper = glm::max(upper, q);
  }
  lower -= kBoxPad;
  upper += kBoxPad;
  area = (upper.x - lower.x) * (upper.y - lower.y);
  const auto corner = [&](double x, double y) { return glm::vec2(x * u + y * v); };
  return {{corner(lower.x, lower.y), corner(upper.x, lower.y), corner(lower.x, upper.y), corner(upper.x, upper.y)}};
}

ScreenBox smallest_box(const SeenCorners& points) {
  double least = 0;
  ScreenBox best = box_along(points, {1, 0}, least);
  for (std::size_t i = 0; i < points.size; ++i) {
    const glm::dvec2 edge = points.at[(i + 1) % points.size] - points.at[i];
    const double length = glm::length(edge);
    if (!(length > 0)) continue;
    double area = 0;
    const ScreenBox box = box_along(points, edge / length, area);
    if (area < least) {
      least = area;
      best = box;
    }
  }
  return best;
}

}  // namespace

BoxFinder::BoxFinder(const visibility::PinholeCamera& camera)
    : eye_(camera.eye),
      across_(camera.screen_across()),
      upward_(camera.screen_upward()),
      forward_(camera.forward),
      half_(0.5 * camera.width, 0.5 * camera.height) {
  require_perspective(camera);
}

void require_perspective(const visibility::PinholeCamera& camera) {
  if (!camera.half_height && !camera.lens) return;
  throw InputError(
      "the camera {}; methods that draw shadow volumes need a pinhole camera. Use another camera (--camera) or method "
      "(edge-scatter, view-sample and raytrace support every camera)",
      camera.half_height ? "is orthographic" : "has a lens with an aperture");
}

glm::dvec2 BoxFinder::project(const glm::dvec3& x) const {
  const glm::dvec3 d = x - eye_;
  const double w = glm::dot(forward_, d);
  return half_ + glm::dvec2(glm::dot(across_, d), -glm::dot(upward_, d)) / w * half_;
}

std::optional<ScreenBox> BoxFinder::around(std::span<const FaceCorner> polygon) const {
  SeenPolygon clipped;
  double reach = 0;
  for (const FaceCorner& corner : polygon) {
    const glm::dvec3 d = corner.infinite ? corner.at : corner.at - eye_;
    clipped.add({glm::dot(across_, d), glm::dot(upward_, d), glm::dot(forward_, d)});
    reach = glm::max(reach, glm::length(d));
  }
  // In double a corner is off by 8 · 2⁻⁵³ · reach · a (a: the longer of across_ and upward_, at least 1, forward_'s
  // length). At a depth of more than 1e-9 · reach · a, the projection is off by up to two of these errors divided by
  // the depth, times up to 16384 pixels. That is less than a thirtieth of a pixel, which kBoxPad covers in addition to
  // the guaranteed eighth.
  const double least_depth = 1e-9 * reach * glm::max(1.0, glm::max(glm::length(across_), glm::length(upward_)));
  // One pixel more than the screen on every side: a face there can still come within an eighth of a pixel.
  const glm::dvec2 limit = 1.0 + 1.0 / half_;
  for (int axis = 0; axis < 2 && clipped.size > 0; ++axis) {
    clipped = cut_to_side(cut_to_side(clipped, axis, 1, limit[axis]), axis, -1, limit[axis]);
  }
  if (clipped.size == 0) return std::nullopt;
  SeenCorners points;
  points.size = clipped.size;
  for (std::size_t i = 0; i < clipped.size; ++i) {
    const glm::dvec3& corner = clipped.corners[i];
    if (!(corner.z > least_depth)) {  // too near for a projection: the whole screen
      points = {{glm::dvec2(0), {2 * half_.x, 0}, 2.0 * half_, {0, 2 * half_.y}}, 4};
      break;
    }
    points.at[i] = half_ + glm::dvec2(corner.x, -corner.y) / corner.z * half_;
  }
  return smallest_box(points);
}

bool BoxFinder::appears_at(const glm::dvec3& x, const glm::dvec2& there) const {
  constexpr double kMost = 1.0 / 16;
  const glm::dvec2 offset = glm::abs(project(x) - there);
  return offset.x <= kMost && offset.y <= kMost;  // false for NaN
}

}  // namespace penumbra::volumes
