// SPDX-License-Identifier: Apache-2.0
// Twin of coverage_table.glsl: places of the table's points, and the shares beyond the edges between them.

#include "volumes/soft/coverage_table.hpp"

#include "base/parallel.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace penumbra::volumes {
namespace {

constexpr int kSide = 32, kCircles = kSide / 2, kSpokes = 2 * kSide;
constexpr std::size_t kPoints = std::size_t{kSide} * kSide;

struct Point {
  glm::dvec2 at{0};
  double fan = 0;
};

double square_fan(double x, double y) {
  const bool steep = std::abs(y) > std::abs(x);
  const double quarter = steep ? (y > 0 ? 1 : 3) : (x > 0 ? 0 : 2);
  return quarter + 0.5 * (steep ? -x / y : y / x);
}

Point square_point(int index) {
  const int x = 2 * (index % kSide) - (kSide - 1), y = 2 * (index / kSide) - (kSide - 1);
  return {glm::dvec2(x, y) / static_cast<double>(kSide - 1), square_fan(x, y)};
}

Point disk_point(int index) {
  const int circle = index / kSpokes;
  const double radius = (2 * circle + 1) / static_cast<double>(2 * kCircles - 1);
  const double half_angle = (index % kSpokes + 0.5) / kSpokes * std::numbers::pi;
  return {radius * glm::dvec2(std::cos(2 * half_angle), std::sin(2 * half_angle)), half_angle};
}

}  // namespace

std::vector<double> coverage_table(const LightOutline& outline, const TextureWeights* texture) {
  const bool disk = outline.corners.empty();
  std::vector<Point> points;
  for (int i = 0; i < static_cast<int>(kPoints); ++i) points.push_back(disk ? disk_point(i) : square_point(i));
  std::vector<double> table(kPoints * kPoints);
  for_each_index(table.size(), [&](std::size_t i) {
    const Point &from = points[i / kPoints], &to = points[i % kPoints];
    if (texture != nullptr) {
      table[i] = texture->up_to_fan(to.fan) - texture->up_to_fan(from.fan) - texture->left_of(from.at, to.at);
      return;
    }
    const double triangle = 0.5 * (from.at.x * to.at.y - from.at.y * to.at.x);
    table[i] = (to.fan - from.fan - triangle) / outline.area;
  });
  return table;
}

}  // namespace penumbra::volumes
