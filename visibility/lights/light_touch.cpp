// SPDX-License-Identifier: Apache-2.0
// Finds triangles that touch a light's plane close to its samples, conservatively, by a tree of boxes.

#include "visibility/lights/light_touch.hpp"

#include "mesh/predicates.hpp"
#include "visibility/pair_truth.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

namespace penumbra::visibility {
namespace {

/// The light's plane in double; the unit of places in it is a cell of a grid with about as many cells as light samples.
class Plane {
 public:
  explicit Plane(const Light& light) : center_(light.center) {
    const auto [center, u, v] = light_frame(light);
    const glm::dvec3 n = glm::cross(u, v);
    normal_ = glm::normalize(n);
    const double some = std::sqrt(static_cast<double>(light.points.size()));
    const glm::dvec2 half_cells = 0.5 * (light.rows > 0 ? glm::dvec2(light.columns, light.rows) : glm::dvec2(some));
    across_ = half_cells.x * glm::cross(v, n) / glm::dot(n, n);
    along_ = half_cells.y * glm::cross(n, u) / glm::dot(n, n);
    skew_ = glm::length(u) * glm::length(v) / glm::length(n);
    length_of_cell_ = glm::length(u) / half_cells.x + glm::length(v) / half_cells.y;
  }

  [[nodiscard]] double height(const glm::dvec3& x) const { return glm::dot(normal_, x - center_); }
  [[nodiscard]] glm::dvec2 cell(const glm::dvec3& x) const {
    return {glm::dot(across_, x - center_), glm::dot(along_, x - center_)};
  }
  [[nodiscard]] double cells_a_length() const { return std::max(glm::length(across_), glm::length(along_)); }
  [[nodiscard]] double length_of_cell() const { return length_of_cell_; }
  /// Returns 1 / sin of the angle between the light's sides.
  [[nodiscard]] double skew() const { return skew_; }

 private:
  glm::dvec3 center_, normal_{0}, across_{0}, along_{0};
  double length_of_cell_ = 0, skew_ = 1;
};

template <typename Point>
struct Box {
  Point low{INFINITY}, high{-INFINITY};
  void add(const Point& x) {
    low = glm::min(low, x);
    high = glm::max(high, x);
  }
};

/// Returns the part of a triangle whose heights are within ±`most`, in cells.
std::vector<glm::dvec2> near_plane(const Plane& plane, const std::array<glm::vec3, 3>& corners, double most) {
  const glm::dvec3 heights(plane.height(corners[0]), plane.height(corners[1]), plane.height(corners[2]));
  const auto [least, highest] = std::minmax({heights.x, heights.y, heights.z});
  if (least > most || highest < -most) return {};
  std::vector<glm::dvec3> polygon(corners.begin(), corners.end());
  for (const double sign : {1.0, -1.0}) {
    std::vector<glm::dvec3> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double ha = most - sign * plane.height(a), hb = most - sign * plane.height(b);
      if (ha >= 0) kept.push_back(a);
      if ((ha > 0 && hb < 0) || (ha < 0 && hb > 0)) kept.push_back(a + (b - a) * (ha / (ha - hb)));
    }
    polygon = std::move(kept);
  }
  std::vector<glm::dvec2> cells;
  for (const glm::dvec3& x : polygon) cells.push_back(plane.cell(x));
  return cells;
}

/// Returns whether the convex polygon meets the box. Separating axes: the box's, and across each side. A side without
/// length separates nothing.
bool meets_box(std::span<const glm::dvec2> polygon, const glm::dvec2& low, const glm::dvec2& high) {
  const glm::dvec2 middle = 0.5 * (low + high), half = 0.5 * (high - low);
  const auto separates = [&](const glm::dvec2& axis) {
    const double reach = std::abs(axis.x) * half.x + std::abs(axis.y) * half.y;
    double least = INFINITY, most = -INFINITY;
    for (const glm::dvec2& x : polygon) {
      const double at = glm::dot(axis, x - middle);
      least = std::min(least, at);
      most = std::max(most, at);
    }
    return least > reach || most < -reach;
  };
  if (polygon.empty() || separates({1, 0}) || separates({0, 1})) return false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 direction = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (separates({-direction.y, direction.x})) return false;
  }
  return true;
}

/// The light samples, prepared for the search.
struct Samples {
  std::vector<glm::dvec2> places;   // in cells
  std::vector<bool> on_plane;       // exactly
  std::vector<std::uint32_t> by_y;  // indices of samples by y
  double off = 0;                   // largest distance of a sample from the plane, in double

  Samples(const Plane& plane, const Light& light) : by_y(light.points.size()) {
    for (const glm::vec3& point : light.points) {
      places.push_back(plane.cell(point));
      off = std::max(off, std::abs(plane.height(point)));
      on_plane.push_back(side_of_plane(light.center, light.center_u, light.center_v, point) == Side::on);
    }
    std::iota(by_y.begin(), by_y.end(), 0U);
    std::ranges::sort(by_y, {}, [&](std::uint32_t j) { return places[j].y; });
  }

  /// Calls `visit(j)` for the samples with y in low … high.
  template <typename Visit>
  void for_each_between(double low, double high, Visit visit) const {
    const auto first = std::ranges::lower_bound(by_y, low, {}, [&](std::uint32_t j) { return places[j].y; });
    for (auto at = first; at != by_y.end() && places[*at].y <= high; ++at) visit(*at);
  }
};

}  // namespace

LightTouch find_touch(const SceneFloats& scene, const TriangleTree& tree, const Light& light) {
  const Plane plane(light);
  const Samples samples(plane, light);
  Box<glm::vec3> box;
  Box<glm::dvec2> cells;
  for (const std::vector<glm::vec3>& points : {light.points, light.outline}) {
    for (const glm::vec3& point : points) {
      box.add(point);
      cells.add(plane.cell(point));
    }
  }
  const glm::vec3 largest =
      glm::max(glm::max(glm::abs(scene.lower), glm::abs(scene.upper)), glm::max(glm::abs(box.low), glm::abs(box.high)));
  // Error of a height: the normal is off by about 2⁻⁵¹ / sin γ, times a distance of up to four times the largest
  // coordinate; a few more roundings. The bound is 32 times that.
  const double rounding = 0x1p-44 * plane.skew() * static_cast<double>(std::max({largest.x, largest.y, largest.z}));
  const double delta = samples.off + rounding, around = 1.0 / 64 + 1024 * delta * plane.cells_a_length();
  const bool all_on_plane = std::ranges::find(samples.on_plane, false) == samples.on_plane.end();
  // Distance that the flattest segment covers while it rises by 3 δ: where p's side of the light is certain (bound
  // level of docs/view-sample.md), p's height H is at least 2⁻²⁰ of its distance from the light's middle and 2⁻²⁰ of
  // the light's size, so no light sample is farther than 2²⁰ H.
  const double flat = 0x1p22 * delta, flat_cells = around + flat * plane.cells_a_length();
  const auto reach = static_cast<float>(1.01 * (flat + around * plane.length_of_cell()));

  LightTouch touch;
  std::vector<bool> touched(samples.places.size());
  tree.for_each_near(box.low - reach, box.high + reach, [&](std::uint32_t triangle) {
    if (scene.emits[triangle] == light.index) return;
    const std::array<glm::vec3, 3> corners = scene.corners(triangle);
    // If double arithmetic decides exactly which corners are in the plane, light samples exactly in the plane need no
    // exact decision.
    const bool clear = std::ranges::all_of(corners, [&](const glm::vec3& corner) {
      const double height = plane.height(corner);
      return height == 0 || std::abs(height) > rounding;
    });
    if (clear && all_on_plane) return;
    const std::vector<glm::dvec2> near = near_plane(plane, corners, 2 * delta);
    if (!meets_box(near, cells.low - flat_cells, cells.high + flat_cells)) return;
    touch.any_near = true;
    Box<glm::dvec2> extent;
    for (const glm::dvec2& x : near) extent.add(x);
    samples.for_each_between(extent.low.y - around, extent.high.y + around, [&](std::uint32_t j) {
      const glm::dvec2 low = samples.places[j] - around, high = samples.places[j] + around;
      if (touched[j] || (clear && samples.on_plane[j]) || extent.low.x > high.x || extent.high.x < low.x) return;
      touched[j] = meets_box(near, low, high);
    });
  });
  for (std::uint32_t j = 0; j < touched.size(); ++j) {
    if (touched[j]) touch.samples.push_back(j);
  }
  return touch;
}

}  // namespace penumbra::visibility
