// SPDX-License-Identifier: Apache-2.0
// Tests boxes cut by half-spaces: exact corners, ties of every kind, and flaws that are found.

#include "volumes/wedges/wedge_polyhedron.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace penumbra::volumes {
namespace {

const Box kBox{{-2, -2, -2}, {2, 2, 2}};

TEST(Polyhedra, AWholeBox) {
  const Polyhedron box = cut_box(kBox, {});
  EXPECT_EQ(box.corners.size(), 8U);
  EXPECT_EQ(box.faces.size(), 6U);
  EXPECT_EQ(flaw_of(box), std::nullopt);
}

TEST(Polyhedra, ACornerCutOff) {
  const Plane plane{-1, -1, -1, 5};
  const Polyhedron cut = cut_box(kBox, std::span(&plane, 1));
  EXPECT_EQ(cut.corners.size(), 10U);
  EXPECT_EQ(cut.faces.size(), 7U);
  EXPECT_EQ(flaw_of(cut), std::nullopt);
  EXPECT_TRUE(std::ranges::any_of(cut.corners, [](const ExactPoint& p) { return p.near == glm::dvec3(1, 2, 2); }));
}

TEST(Polyhedra, FlatAndEmpty) {
  const auto extent = [](const Plane& plane) { return cut_box(kBox, std::span(&plane, 1)).extent; };
  EXPECT_EQ(extent({1, 0, 0, -2}), Extent::flat) << "touches a face";
  EXPECT_EQ(extent({1, 1, 1, -6}), Extent::flat) << "touches a corner";
  EXPECT_EQ(extent({1, 0, 0, -2.5}), Extent::empty);
  EXPECT_EQ(extent({1, 0, 0, 2}), Extent::solid) << "the half-space contains the whole polyhedron";
}

/// A third is not a double: the corner is rational, and the plane's sign there is exactly zero.
TEST(Polyhedra, CornersAreExact) {
  const Plane planes[] = {{3, 0, 0, -1}, {0, 7, 0, -1}, {0, 0, -11, 1}};
  const Polyhedron cut = cut_box(kBox, planes);
  EXPECT_EQ(flaw_of(cut), std::nullopt);
  const auto corner = std::ranges::find_if(cut.corners, [&](const ExactPoint& p) {
    return std::ranges::all_of(planes, [&](const Plane& plane) { return side_of(plane, p) == 0; });
  });
  ASSERT_NE(corner, cut.corners.end());
  EXPECT_EQ(corner->at[0], mpq_class(1, 3));
  EXPECT_EQ(corner->at[1], mpq_class(1, 7));
  EXPECT_EQ(corner->at[2], mpq_class(1, 11));
}

/// Planes with tiny whole coefficients pass through corners, edges and faces of what is left: ties are the rule.
TEST(Polyhedra, LatticePlanes) {
  std::mt19937 engine(1);
  const auto whole = [&](int range) {
    return static_cast<double>(static_cast<int>(engine() % (2 * static_cast<unsigned>(range) + 1)) - range);
  };
  std::size_t solid = 0, points_inside = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<Plane> planes;
    for (std::uint32_t i = 0; i < 1 + engine() % 8; ++i) {
      const Plane plane{whole(2), whole(2), whole(2), whole(2) + 1};
      if (plane.normal() != glm::dvec3(0)) planes.push_back(plane);
    }
    const Polyhedron cut = cut_box(kBox, planes);
    if (cut.extent != Extent::solid) continue;
    ++solid;
    const auto flaw = flaw_of(cut);
    ASSERT_FALSE(flaw) << "round " << round << ": " << *flaw;
    for (int i = 0; i < 40; ++i) {
      const glm::dvec3 p(whole(5) / 2, whole(5) / 2, whole(5) / 2);
      const bool in_box = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= 2;
      const bool inside =
          in_box && std::ranges::all_of(planes, [&](const Plane& plane) { return side_of(plane, p) >= 0; });
      EXPECT_EQ(inside, mesh_holds(cut, p)) << "round " << round;
      points_inside += inside ? 1 : 0;
    }
  }
  EXPECT_GT(solid, 100U);
  EXPECT_GT(points_inside, 500U);
}

TEST(Polyhedra, FlawsAreFound) {
  const Plane plane{-1, -1, -1, 5};
  const Polyhedron sound = cut_box(kBox, std::span(&plane, 1));
  Polyhedron open = sound;
  open.faces.pop_back();
  EXPECT_TRUE(flaw_of(open));
  Polyhedron turned = sound;
  for (PolyhedronFace& face : turned.faces) std::ranges::reverse(face.loop);
  EXPECT_TRUE(flaw_of(turned));
  Polyhedron dented = sound;
  dented.corners[0] = ExactPoint(glm::dvec3(0, 0, 0));
  EXPECT_TRUE(flaw_of(dented));
  Polyhedron doubled = sound;
  doubled.faces.push_back(doubled.faces[0]);
  EXPECT_TRUE(flaw_of(doubled));
}

}  // namespace
}  // namespace penumbra::volumes
