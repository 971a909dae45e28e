// SPDX-License-Identifier: Apache-2.0
// Effects of a carrier's plane on sums over edges at a view sample that rounding moved off the plane.

#include "volumes/raster/carrier_horizon.hpp"

#include "base/assert.hpp"
#include "visibility/pair_truth.hpp"
#include "volumes/raster/volume_count.shared.h"
#include "volumes/raster/small_vectors.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra::volumes {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostSamples = 32;

/// Returns the distance from p to the triangle's edges. Its error is below 2⁻⁴⁰ of the result and of the coordinates.
double distance_to_rim(const glm::vec3& p, const std::array<glm::vec3, 3>& corners) {
  double nearest = kInfinity;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 a(corners[i]), direction = glm::dvec3(corners[(i + 1) % 3]) - a, to_p = glm::dvec3(p) - a;
    const double t = std::clamp(glm::dot(to_p, direction) / glm::dot(direction, direction), 0.0, 1.0);
    nearest = std::min(nearest, glm::length(to_p - t * direction));
  }
  return nearest;
}

/// Returns x moved outward by at least `room`.
float moved(float x, double room, float outward) {
  return std::nextafter(static_cast<float>(x + std::copysign(room, static_cast<double>(outward))), outward);
}

}  // namespace

CarrierHorizon::CarrierHorizon(const visibility::SceneFloats& scene, const visibility::TriangleTree& tree,
                               std::uint32_t carrier, std::int8_t facing, bool alone)
    : scene_(scene), tree_(tree), carrier_(carrier), facing_(facing), alone_(alone), corners_(scene.corners(carrier)) {
  const glm::dvec3 a(corners_[0]), ab = glm::dvec3(corners_[1]) - a, ac = glm::dvec3(corners_[2]) - a;
  normal_ = static_cast<double>(facing) * glm::cross(ab, ac);
  size_ = gpu::kDeterminantError * norm1(ab) * norm1(ac);
}

Horizon CarrierHorizon::at(const glm::vec3& p, const glm::vec3& center, std::span<const glm::vec3> points) const {
  PENUMBRA_ASSERT(points.size() <= kMostSamples, "{} light samples", points.size());
  Horizon horizon;
  for (std::size_t j = 0; j < points.size(); ++j) {
    const double h = height(points[j]), e = error(points[j]);
    const bool above = h > e || (h >= -e && visibility::above_horizon(corners_, facing_, points[j]));
    horizon.above |= above ? 1U << j : 0;
  }
  if (!is_behind(p)) return horizon;
  std::array<double, kMostSamples> reaches{};
  const double to_center = reach(p, center);
  double farthest = to_center;
  for (std::size_t j = 0; j < points.size(); ++j) {
    reaches[j] = std::max(to_center, reach(p, points[j]));
    if ((horizon.above >> j & 1U) != 0) farthest = std::max(farthest, reaches[j]);
  }
  const double free = distance_to_edges(p, farthest);
  for (std::size_t j = 0; j < points.size(); ++j) horizon.open |= reaches[j] < free ? 0 : 1U << j;
  horizon.open &= horizon.above;
  return horizon;
}

double CarrierHorizon::height(const glm::vec3& x) const {
  return glm::dot(normal_, glm::dvec3(x) - glm::dvec3(corners_[0]));
}

double CarrierHorizon::error(const glm::vec3& x) const {
  return size_ * norm1(glm::dvec3(x) - glm::dvec3(corners_[0]));
}

bool CarrierHorizon::is_behind(const glm::vec3& p) const {
  const double h = height(p), e = error(p);
  if (std::abs(h) > e) return h < 0;
  return static_cast<int>(visibility::side_of_plane(corners_[0], corners_[1], corners_[2], p)) * facing_ < 0;
}

/// Returns an upper bound of the distance from p at which the segment to l crosses the plane, including the error of
/// distances. Infinite if l is hardly above the plane.
double CarrierHorizon::reach(const glm::vec3& p, const glm::vec3& l) const {
  const double off = std::abs(height(p)) + error(p), h = height(l) - error(l);
  if (!(h > 0)) return kInfinity;
  const double rounding = 0x1p-40 * (norm1(glm::dvec3(p)) + norm1(glm::dvec3(l)));
  return 1.001 * off / h * glm::length(glm::dvec3(l) - glm::dvec3(p)) + rounding;
}

/// Returns the distance from p to the edges of triangles on the plane: of the carrier, and of others within `farthest`.
double CarrierHorizon::distance_to_edges(const glm::vec3& p, double farthest) const {
  double nearest = distance_to_rim(p, corners_);
  const double room = std::min(nearest, farthest);
  if (alone_) return nearest;
  glm::vec3 lower, upper;
  for (int i = 0; i < 3; ++i) {
    lower[i] = moved(p[i], room, -std::numeric_limits<float>::infinity());
    upper[i] = moved(p[i], room, std::numeric_limits<float>::infinity());
  }
  tree_.for_each_near(lower, upper, [&](std::uint32_t triangle) {
    if (scene_.plane[triangle] != scene_.plane[carrier_]) return;
    nearest = std::min(nearest, distance_to_rim(p, scene_.corners(triangle)));
  });
  return nearest;
}

}  // namespace penumbra::volumes
