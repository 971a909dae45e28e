// SPDX-License-Identifier: Apache-2.0
// Emissive meshes as lights: whole, or in pieces.
#include "import/gltf/emitters/emitter.hpp"

#include "tests/unit/import/lamp_shapes.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace penumbra::scenes {
namespace {

using test::LampMesh;

constexpr double kRounding = 1e-6;

import::Emitter emitter_of(const LampMesh& lamp, bool two_sided = false){
    auto found = import::recognise_emitter(lamp.points, lamp.triangles, two_sided, kRounding);
EXPECT_TRUE(std::holds_alternative<import::Emitter>(found)) << std::get<std::string>(found);
return std::holds_alternative<import::Emitter>(found) ? std::get<import::Emitter>(std::move(found)) : import::Emitter{};
}  // namespace

struct AddCorners {
  std::vector<std::vector<glm::dvec3>>& all;
  void operator()(const Rectangle& r) const {
    all.push_back({r.center - r.half_u - r.half_v, r.center + r.half_u - r.half_v, r.center + r.half_u + r.half_v,
                   r.center - r.half_u + r.half_v});
  }
  void operator()(const Polygon& polygon) const { all.push_back(polygon.vertices); }
  void operator()(const Pieces& pieces) const {
    for (const Pieces::Piece& piece : pieces.pieces) std::visit(*this, piece);
  }
  void operator()(const auto& /*round*/) const {}
};

/// Returns the corners of the emitter's pieces, or of its only piece, counter-clockwise. Spheres have none.
std::vector<std::vector<glm::dvec3>> outlines_of(const import::Emitter& emitter) {
  std::vector<std::vector<glm::dvec3>> all;
  std::visit(AddCorners{all}, emitter.shape);
  return all;
}

glm::dvec3 vector_area(const std::vector<glm::dvec3>& corners) {
  glm::dvec3 sum(0);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    sum += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]) / 2.0;
  return sum;
}

std::size_t rectangles_in(const import::Emitter& emitter) {
  const auto& pieces = std::get<Pieces>(emitter.shape).pieces;
  return static_cast<std::size_t>(
      std::ranges::count_if(pieces, [](const auto& piece) { return std::holds_alternative<Rectangle>(piece); }));
}

/// Each triangle's middle is in exactly one piece, which faces the same side; areas add up; pieces are convex.
void expect_covered(const LampMesh& lamp, const import::Emitter& emitter) {
  const auto outlines = outlines_of(emitter);
  double area = 0;
  for (const auto& corners : outlines) {
    const glm::dvec3 normal = glm::normalize(vector_area(corners));
    area += glm::length(vector_area(corners));
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const glm::dvec3 along = corners[(i + 1) % corners.size()] - corners[i];
      for (const glm::dvec3& other : corners)
        EXPECT_GT(glm::dot(glm::cross(normal, glm::normalize(along)), other - corners[i]), -1e-9);
    }
  }
  EXPECT_NEAR(area, lamp.area(), 1e-9);
  for (const mesh::Triangle& t : lamp.triangles) {
    const glm::dvec3 middle = (lamp.points[t[0]] + lamp.points[t[1]] + lamp.points[t[2]]) / 3.0;
    const glm::dvec3 facing = glm::normalize(lamp.vector_area(t));
    const auto has_it = [&](const std::vector<glm::dvec3>& corners) {
      const glm::dvec3 normal = glm::normalize(vector_area(corners));
      if (glm::dot(normal, facing) < 1 - 1e-9 || std::abs(glm::dot(normal, middle - corners[0])) > 1e-9) return false;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 along = corners[(i + 1) % corners.size()] - corners[i];
        if (glm::dot(glm::cross(normal, along), middle - corners[i]) < 0) return false;
      }
      return true;
    };
    EXPECT_EQ(std::ranges::count_if(outlines, has_it), 1);
  }
}

TEST(Emitter, ACubeIsSixRectanglesThatShineOutward) {
  for (const int side : {1, 4}) {
    LampMesh cube = test::cube_lamp({1, 2, 3}, 0.5, side);
    for (const bool inward : {false, true}) {
      if (inward) cube.turn();
      const import::Emitter emitter = emitter_of(cube, true);
      EXPECT_EQ(rectangles_in(emitter), 6U);
      EXPECT_EQ(std::get<Pieces>(emitter.shape).pieces.size(), 6U);
      EXPECT_FALSE(emitter.two_sided) << "a closed body's inside cannot be seen";
      EXPECT_FALSE(emitter.hides_itself);
      for (const auto& corners : outlines_of(emitter))
        EXPECT_GT(glm::dot(vector_area(corners), corners[0] - glm::dvec3(1, 2, 3)), 0) << "outward";
    }
    const import::Emitter room = emitter_of(cube);  // faces inward, and is one-sided
    EXPECT_TRUE(room.hides_itself);
    for (const auto& corners : outlines_of(room))
      EXPECT_LT(glm::dot(vector_area(corners), corners[0] - glm::dvec3(1, 2, 3)), 0);
    expect_covered(cube, room);
  }
}

TEST(Emitter, FlatOutlinesThatAreNotConvexAreCut) {
  for (const double size : {2.0, 0.002}) {  // its dents are far deeper than rounding errors
    const LampMesh star = test::star_lamp({0, 5, 0}, size, 0.4 * size, 5);
    const import::Emitter emitter = emitter_of(star, true);
    expect_covered(star, emitter);
    EXPECT_LE(outlines_of(emitter).size(), 6U);
    EXPECT_TRUE(emitter.two_sided);
    EXPECT_FALSE(emitter.hides_itself) << "a flat emitter hides nothing of itself";
  }

  LampMesh frame;  // a hole in the middle
  const auto square = [](double x, double z) { return glm::dvec3(x, 1, z); };
  for (int x = 0; x < 3; ++x) {
    for (int z = 0; z < 3; ++z) {
      if (x == 1 && z == 1) continue;
      frame.add({square(x, z), square(x + 1, z), square(x + 1, z + 1), square(x, z + 1)});
    }
  }
  expect_covered(frame, emitter_of(frame));
  EXPECT_LE(outlines_of(emitter_of(frame)).size(), 5U);
  EXPECT_EQ(rectangles_in(emitter_of(frame)), outlines_of(emitter_of(frame)).size());
}

/// An outline that bends inward a little, but by more than rounding, is cut: its two triangles do not join.
TEST(Emitter, OutlinesThatBendInwardALittleAreCut) {
  for (const double dent : {0.3, 0.01, 1e-4}) {
    LampMesh dart;
    dart.add({{0, 1, -dent}, {1, 1, 0}, {0, 1, -2}, {-1, 1, 0}});
    expect_covered(dart, emitter_of(dart));
    EXPECT_EQ(outlines_of(emitter_of(dart)).size(), 2U) << dent;
  }
}

TEST(Emitter, TubesAndPanels) {
  const LampMesh open = test::tube_lamp({0, 3, 0}, 0.1, 1, 12, false),
                 closed = test::tube_lamp({0, 3, 0}, 0.1, 1, 12, true);
  expect_covered(open, emitter_of(open));
  EXPECT_EQ(rectangles_in(emitter_of(open)), 12U);
  EXPECT_FALSE(emitter_of(open).hides_itself);
  EXPECT_TRUE(emitter_of(open, true).two_sided);
  EXPECT_TRUE(emitter_of(open, true).hides_itself) << "through its open ends the inside can be seen";
  expect_covered(closed, emitter_of(closed, true));
  EXPECT_EQ(outlines_of(emitter_of(closed, true)).size(), 14U);
  EXPECT_FALSE(emitter_of(closed, true).two_sided);

  const LampMesh panels = test::two_panels({0, 3, 0});
  expect_covered(panels, emitter_of(panels));
  EXPECT_EQ(rectangles_in(emitter_of(panels)), 2U);

  LampMesh bent;
  bent.add({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.01}, {0, 1, 0}});
  expect_covered(bent, emitter_of(bent));
  EXPECT_EQ(outlines_of(emitter_of(bent)).size(), 2U);
}

TEST(Emitter, SpheresWhereTheMeshIsFineEnough) {
  EXPECT_TRUE(std::holds_alternative<Sphere>(emitter_of(test::ball_lamp({1, 2, 3}, 0.3, 2), true).shape));
  const LampMesh coarse = test::ball_lamp({1, 2, 3}, 0.3, 1);
  expect_covered(coarse, emitter_of(coarse, true));
  EXPECT_EQ(outlines_of(emitter_of(coarse, true)).size(), 80U);
  LampMesh bulbs = test::ball_lamp({1, 2, 3}, 0.3, 2);
  const LampMesh other = test::ball_lamp({3, 2, 3}, 0.2, 2);
  const auto first = static_cast<std::uint32_t>(bulbs.points.size());
  bulbs.points.insert(bulbs.points.end(), other.points.begin(), other.points.end());
  for (const mesh::Triangle& t : other.triangles) bulbs.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  const auto pieces = std::get<Pieces>(emitter_of(bulbs, true).shape).pieces;
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_NEAR(std::get<Sphere>(pieces[1]).radius, 0.2, 0.002);
}

TEST(Emitter, WhatAClosedMeshEnclosesIsNotSeen) {
  LampMesh shell = test::cube_lamp({0, 0, 0}, 1);  // as Blender's Solidify modifier makes it from a box
  LampMesh inner = test::cube_lamp({0, 0, 0}, 0.9);
  inner.turn();
  for (const mesh::Triangle& t : inner.triangles)
    shell.add({inner.points[t[0]], inner.points[t[1]], inner.points[t[2]]});
  for (const bool two_sided : {false, true}) EXPECT_EQ(outlines_of(emitter_of(shell, two_sided)).size(), 6U);
}

TEST(Emitter, WhatIsThereTwiceShinesOnce) {
  LampMesh panel;
  panel.add({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  panel.add({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  EXPECT_EQ(outlines_of(emitter_of(panel)).size(), 1U);
  panel.add({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}});  // its back side
  EXPECT_EQ(outlines_of(emitter_of(panel)).size(), 2U);
  EXPECT_EQ(outlines_of(emitter_of(panel, true)).size(), 1U);
  EXPECT_TRUE(emitter_of(panel, true).two_sided);
}

TEST(Emitter, WhatIsNoneSaysWhy) {
  const auto why_not = [](const LampMesh& lamp) {
    const auto found = import::recognise_emitter(lamp.points, lamp.triangles, false, kRounding);
    return std::holds_alternative<std::string>(found) ? std::get<std::string>(found) : "it is a light";
  };
  LampMesh line;
  line.add({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  EXPECT_EQ(why_not(line), "it has no area");
  LampMesh many;
  for (int i = 0; i <= static_cast<int>(import::kMostPieces); ++i)
    many.add({{3 * i, 0, 0}, {3 * i + 1, 0, 0}, {3 * i, 1, i}});
  EXPECT_NE(why_not(many).find("cut into more than 1024 flat pieces"), std::string::npos) << why_not(many);
}

/// Stairs on a tiny lattice: regions of every shape, in every direction, with holes.
TEST(Emitter, RandomStairsAreCoveredOnce) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
    std::vector<glm::dvec3> grid;
    for (int z = 0; z < 6; ++z) {
      for (int x = 0; x < 6; ++x) grid.emplace_back(x, below(2), z);
    }
    LampMesh stairs;
    for (std::size_t z = 0; z < 5; ++z) {
      for (std::size_t x = 0; x < 5; ++x) {
        const std::size_t i = 6 * z + x;
        if (below(6) == 0) continue;
        if (below(2) == 0) {
          stairs.add({grid[i], grid[i + 6], grid[i + 7]});
          stairs.add({grid[i], grid[i + 7], grid[i + 1]});
        } else {
          stairs.add({grid[i], grid[i + 6], grid[i + 1]});
          stairs.add({grid[i + 1], grid[i + 6], grid[i + 7]});
        }
      }
    }
    SCOPED_TRACE("seed " + std::to_string(seed));
    expect_covered(stairs, emitter_of(stairs));
  }
}

}  // namespace penumbra::scenes
}  // namespace penumbra::scenes
