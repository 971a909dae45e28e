// SPDX-License-Identifier: Apache-2.0
#include "visibility/lens.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

namespace penumbra::visibility {
namespace {

constexpr std::uint32_t kAcross = 40;  // pixels of a picture, along both axes

/// Returns all points of one pixel on a lens of radius 1.
std::vector<glm::dvec2> points_of(std::uint32_t pixel_x, std::uint32_t pixel_y, std::uint32_t side,
                                  std::uint32_t moments) {
  std::vector<glm::dvec2> points;
  for (std::uint32_t moment = 0; moment < moments; ++moment) {
    const Lens lens{.radius = 1, .focus_distance = 1, .side = side, .moment = moment, .moments = moments};
    for (std::uint32_t i = 0; i < side * side; ++i)
      points.push_back(lens.point(pixel_x * side + i % side, pixel_y * side + i / side));
  }
  return points;
}

/// Returns the point of the square that Shirley and Chiu's map takes to this point of the disk, by the areas of rings
/// and sectors (four wedges).
glm::dvec2 on_square(const glm::dvec2& disk) {
  const double radius = glm::length(disk);
  double angle = std::atan2(disk.y, disk.x);
  const auto quarter = static_cast<int>(std::floor((angle + std::numbers::pi / 4) / (std::numbers::pi / 2)));
  angle -= quarter * std::numbers::pi / 2;  // within an eighth of a turn of the middle of its wedge
  const double along = radius, beside = radius * angle * 4 / std::numbers::pi;
  const std::array<glm::dvec2, 4> turned{{{along, beside}, {-beside, along}, {-along, -beside}, {beside, -along}}};
  return 0.5 + 0.5 * turned[static_cast<std::size_t>((quarter + 4) % 4)];
}

/// A pixel has side × side points in each of `moments` pictures that are averaged. No two of its points share a cell, a
/// column or a row.
TEST(Lens, PointsOfAPixelAreEvenlySpread) {
  const std::vector<std::array<std::uint32_t, 4>> layouts = {
      // side, moments, columns, rows
      {2, 1, 2, 2}, {3, 1, 3, 3}, {4, 1, 4, 4}, {8, 1, 8, 8}, {1, 16, 4, 4}, {2, 3, 2, 6}, {4, 6, 8, 12}, {1, 7, 1, 7}};
  for (const auto& [side, moments, columns, rows] : layouts) {
    const std::uint32_t count = side * side * moments;
    for (std::uint32_t pixel = 0; pixel < 25; ++pixel) {
      std::set<std::pair<std::uint32_t, std::uint32_t>> cells;
      std::set<std::uint32_t> fine_columns, fine_rows;
      for (const glm::dvec2& disk : points_of(pixel % 5, pixel / 5, side, moments)) {
        ASSERT_LE(glm::length(disk), 1 + 1e-15);
        const glm::dvec2 at = on_square(disk);
        cells.emplace(static_cast<std::uint32_t>(at.x * columns), static_cast<std::uint32_t>(at.y * rows));
        fine_columns.insert(static_cast<std::uint32_t>(at.x * count));
        fine_rows.insert(static_cast<std::uint32_t>(at.y * count));
      }
      EXPECT_EQ(cells.size(), count) << side << " " << moments;
      EXPECT_EQ(fine_columns.size(), count) << side << " " << moments;
      EXPECT_EQ(fine_rows.size(), count) << side << " " << moments;
    }
  }
}

/// For a fixed place in the pixel, the points of all pixels spread over the whole lens: half of them are within half
/// the area, and half on each side of both axes, to four standard errors.
TEST(Lens, PointsOfAPlaceInAPixelAreAnywhere) {
  const Lens lens{.radius = 0.5, .focus_distance = 1, .side = 4, .moment = 1, .moments = 4};
  for (std::uint32_t place = 0; place < 16; ++place) {
    std::array<int, 3> counts{};
    for (std::uint32_t pixel = 0; pixel < kAcross * kAcross; ++pixel) {
      const glm::dvec2 at = lens.point(pixel % kAcross * 4 + place % 4, pixel / kAcross * 4 + place / 4);
      counts[0] += glm::length(at) < 0.5 * std::sqrt(0.5) ? 1 : 0;
      counts[1] += at.x < 0 ? 1 : 0;
      counts[2] += at.y < 0 ? 1 : 0;
    }
    for (const int count : counts) EXPECT_NEAR(count, kAcross * kAcross / 2, 4 * 0.5 * kAcross) << place;
  }
  EXPECT_EQ(lens.point(5, 7), lens.point(5, 7));
}

}  // namespace
}  // namespace penumbra::visibility
