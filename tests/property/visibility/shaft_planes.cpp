// SPDX-License-Identifier: Apache-2.0
// Compares the triangles that a tree finds in a shaft with a test of each triangle against each plane.

#include "visibility/seen/shaft_planes.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace penumbra::visibility {
namespace {

class ScatteredTriangles {
 public:
  explicit ScatteredTriangles(std::uint32_t triangles) {
    std::vector<MiddleBox> boxes;
    for (std::uint32_t i = 0; i < triangles; ++i) {
      const glm::dvec3 middle = 10.0 * point();
      for (int corner = 0; corner < 3; ++corner) soup_.positions.push_back(middle + 0.3 * point());
      soup_.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
      const glm::dvec3 *const a = &soup_.positions[std::size_t{3} * i], lower = glm::min(a[0], glm::min(a[1], a[2])),
                              upper = glm::max(a[0], glm::max(a[1], a[2]));
      boxes.push_back({0.5 * (lower + upper), 0.5 * (upper - lower)});
    }
    tree_ = BoxTree(boxes, 4);
  }

  /// Returns planes at random distances, with the middle of the soup inside all of them.
  ShaftPlanes planes(std::uint32_t count) {
    ShaftPlanes planes;
    for (std::uint32_t i = 0; i < count; ++i) planes.add(point(), 6.0 + 3.0 * unit_(random_));
    return planes;
  }

  [[nodiscard]] std::vector<std::uint32_t> found(const ShaftPlanes& planes) const {
    std::vector<std::uint32_t> triangles;
    touched(tree_, soup_, planes, triangles);
    std::ranges::sort(triangles);
    return triangles;
  }
  /// Returns the triangles that are not entirely outside any plane by at least `margin`.
  [[nodiscard]] std::vector<std::uint32_t> inside(const ShaftPlanes& planes, double margin) const {
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t i = 0; i < soup_.triangles.size(); ++i) {
      bool reaches = true;
      for (std::uint32_t plane = 0; plane < planes.count; ++plane) {
        const glm::dvec3 normal(planes.x[plane], planes.y[plane], planes.z[plane]);
        reaches = reaches && std::ranges::any_of(soup_.triangles[i], [&](std::uint32_t corner) {
                    return glm::dot(normal, soup_.positions[corner]) <= planes.most[plane] + margin;
                  });
      }
      if (reaches) triangles.push_back(i);
    }
    return triangles;
  }

 private:
  glm::dvec3 point() { return {unit_(random_), unit_(random_), unit_(random_)}; }

  std::mt19937 random_{11};
  std::uniform_real_distribution<double> unit_{-1, 1};
  mesh::TriangleSoup soup_;
  BoxTree tree_;
};

TEST(ShaftPlanes, FindTheTrianglesThatNoPlaneHasOutside) {
  ScatteredTriangles scattered(3000);
  std::size_t some = 0;
  // Fewer planes than a vector has lanes, as many, one more, several vectors of them, and the largest number.
  for (const std::uint32_t count : {0U, 1U, 2U, 3U, 4U, 5U, 7U, 8U, 9U, 16U, 25U, 63U, 64U}) {
    for (int i = 0; i < 20; ++i) {
      const ShaftPlanes planes = scattered.planes(count);
      const std::vector<std::uint32_t> found = scattered.found(planes);
      // Boxes and dot products are rounded: 2⁻⁵⁰ of values below 64.
      EXPECT_TRUE(std::ranges::includes(found, scattered.inside(planes, -0x1p-44))) << count << " planes";
      EXPECT_TRUE(std::ranges::includes(scattered.inside(planes, 0x1p-44), found)) << count << " planes";
      some += found.empty() || found.size() == 3000 ? 0 : 1;
    }
  }
  EXPECT_GT(some, 150U);
}

TEST(ShaftPlanes, BeyondTheMostAreLeftOut) {
  ScatteredTriangles scattered(300);
  ShaftPlanes planes = scattered.planes(ShaftPlanes::kMost);
  const std::vector<std::uint32_t> found = scattered.found(planes);
  planes.add({1, 0, 0}, -100);  // this plane would exclude all triangles
  EXPECT_EQ(planes.count, ShaftPlanes::kMost);
  EXPECT_EQ(scattered.found(planes), found);
}

}  // namespace
}  // namespace penumbra::visibility
