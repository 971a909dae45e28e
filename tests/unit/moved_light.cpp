// SPDX-License-Identifier: Apache-2.0
// Tests how --frame moves a light from one frame to the next.

#include "bench/moved_light.hpp"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace penumbra::bench {
namespace {

// About a dozen sums and products of numbers up to 5, each with a rounding error of 2⁻⁵³ of itself.
constexpr double kRounding = 12 * 5 * 0x1p-53;

template <typename Shape>
Shape moved(const Shape& shape) {
  return std::get<Shape>(moved_light(shape));
}

TEST(MovedLight, GoesATwelfthOfItsWidthWithinItsPlane) {
  const glm::dvec3 center(1, 5, 2), u(3, 0, 4), v(0, 0.5, 0);
  const glm::dvec3 of_rectangle = moved(scenes::Rectangle{center, u, v}).center - center;
  EXPECT_NEAR(glm::length(of_rectangle - u / 6.0), 0, kRounding);
  const glm::dvec3 of_ellipse = moved(scenes::Ellipse{center, u, v}).center - center;
  EXPECT_NEAR(glm::length(of_ellipse - u / 6.0), 0, kRounding);
  for (const glm::dvec3& normal : {glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0.6, 0, 0.8)}) {
    const glm::dvec3 of_disk = moved(scenes::Disk{center, normal, 3}).center - center;
    EXPECT_NEAR(glm::length(of_disk), 0.5, kRounding);
    EXPECT_NEAR(glm::dot(of_disk, normal), 0, kRounding);
  }
  const scenes::Polygon triangle{{center, center + u, center + v}};
  const scenes::Polygon there = moved(triangle);
  for (std::size_t i = 0; i < triangle.vertices.size(); ++i)
    EXPECT_NEAR(glm::length(there.vertices[i] - triangle.vertices[i] - u / 12.0), 0, kRounding);
  EXPECT_NEAR(glm::length(moved(scenes::Sphere{center, 3}).center - center), 0.5, kRounding);
}

TEST(MovedLight, OfASunTurnsByATwelfthOfItsAngle) {
  for (const double angle : {0.0, 0.53, 40.0}) {
    for (const glm::dvec3& direction : {glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0.6, 0, -0.8)}) {
      const glm::dvec3 there = moved(scenes::Sun{direction, angle}).direction;
      EXPECT_NEAR(glm::length(there), 1, kRounding);
      const double turned = std::asin(glm::length(glm::cross(direction, there)));
      EXPECT_NEAR(glm::degrees(turned), (angle > 0 ? angle : 0.5) / 12, 180 * kRounding);
    }
  }
}

TEST(MovedLight, InPiecesIsRefused) {
  EXPECT_THROW(moved_light(scenes::Pieces{{scenes::Sphere{{}, 1}}}), std::logic_error);
}

}  // namespace
}  // namespace penumbra::bench
