// SPDX-License-Identifier: Apache-2.0
// Closed parts drop the triangles that pairs outside of them do not need: not one bit may change. The parts here are
// the worst that are still closed: they are connected like spheres, but with vertices anywhere on a lattice, so that
// they cross themselves, touch their box, the floor and the view samples, and have hardly any inside.

#include "mesh/shapes/shapes.hpp"
#include "tests/agreement/lattice.hpp"
#include "tests/agreement/support.hpp"
#include "vsm/closed_parts.hpp"

#include <glm/common.hpp>

#include <algorithm>
#include <tuple>

namespace penumbra::vsm {
namespace {

using visibility::Light;
using visibility::SceneFloats;
using visibility::ViewSamples;

/// Returns an icosphere's triangles with its vertices at different random points of the lattice −range … range.
std::vector<tests::Corners> tangled_sphere(tests::LatticeSoup& soup, int range) {
  const mesh::TriangleSoup sphere = mesh::make_icosphere(glm::dvec3(0), 1, 1);
  std::vector<glm::dvec3> lattice;
  for (int x = -range; x <= range; ++x) {
    for (int y = -range; y <= range; ++y) {
      for (int z = -range; z <= range; ++z) lattice.emplace_back(x, y, z);
    }
  }
  std::ranges::shuffle(lattice, soup.random());
  std::vector<tests::Corners> triangles;
  for (const mesh::Triangle& t : sphere.triangles) triangles.push_back({lattice[t[0]], lattice[t[1]], lattice[t[2]]});
  return triangles;
}

/// Objects: 0 is a part, 1 has lattice triangles outside the part's box or on its faces, 2 has lattice triangles
/// anywhere.
scenes::Scene tangled_scene(tests::LatticeSoup& soup, int range, visibility::SampleRequest& request) {
  scenes::Scene scene;
  scene.lights.push_back(soup.light(request));
  const std::vector<tests::Corners> part = tangled_sphere(soup, range);
  tests::add_object(scene, "part", part);
  std::vector<tests::Corners> outside;
  while (outside.size() < 12) {
    tests::Corners corners{2.0 * soup.point(), 2.0 * soup.point(), 2.0 * soup.point()};
    const int axis = static_cast<int>(soup.below(3));
    const double face = (soup.below(4) == 0 ? range + 1.0 : range) * (soup.below(2) == 0 ? 1 : -1);
    for (glm::dvec3& corner : corners) {
      const glm::dvec3& of_part =
          part[soup.below(80)][soup.below(3)];  // a place where the part touches the face, if it does
      if (of_part[axis] == face) corner = of_part;
      corner[axis] = face;
    }
    outside.push_back(corners);
  }
  tests::add_object(scene, "outside", outside);
  tests::add_object(scene, "anywhere", soup.triangles(4));
  return scene;
}

class ClosedPartsOnDevice : public tests::DeviceTest,
                            public testing::WithParamInterface<std::tuple<int, const char*>> {};

TEST_P(ClosedPartsOnDevice, EveryPairIsTheExactDecision) {
  const auto& [range, engine] = GetParam();
  const auto method = make_view_sample(device(), {{"engine", engine}});
  tests::PairCounts counts;
  int with_parts = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    tests::LatticeSoup soup(seed + 1000 * static_cast<std::uint32_t>(range), range);
    visibility::SampleRequest request;
    const scenes::Scene scene = tangled_scene(soup, range, request);
    const SceneFloats floats = visibility::make_scene_floats(scene);
    const Light light = visibility::make_light(scene, 0, floats.origin, request);
    const ClosedParts closed = find_closed_parts(floats);
    with_parts += parts_apart_from(closed, visibility::make_device_light(light, 1), 1) != 0 ? 1 : 0;
    ViewSamples samples = tests::samples_on_triangles(floats, 8, 16, soup.random(), 1);
    tests::append(samples, tests::samples_on_triangles(floats, 8, 2, soup.random(), 0));
    tests::append(samples, tests::samples_on_triangles(floats, 8, 4, soup.random(), 2));
    const tests::Masks masks = tests::run(*method, floats, light, samples);
    EXPECT_TRUE(equals_truth(floats, light, samples, masks, &counts)) << "seed " << seed << " range " << range;
  }
  EXPECT_GT(with_parts, 5);
  EXPECT_GT(counts.visible, counts.pairs / 20);
  EXPECT_GT(counts.blocked, counts.pairs / 20);
}

INSTANTIATE_TEST_SUITE_P(Range, ClosedPartsOnDevice,
                         testing::Combine(testing::Values(4, 8, 16), testing::Values("vulkan", "native")),
                         [](const auto& it) {
                           return fmt::format("{}_{}", std::get<1>(it.param), std::get<0>(it.param));
                         });

SceneFloats floats_of(const mesh::TriangleSoup& soup, const std::vector<tests::Corners>& more = {}) {
  scenes::Scene scene;
  std::vector<tests::Corners> triangles;
  for (const auto& [a, b, c] : soup.triangles)
    triangles.push_back({soup.positions[a], soup.positions[b], soup.positions[c]});
  tests::add_object(scene, "part", triangles);
  tests::add_object(scene, "more", more);
  return visibility::make_scene_floats(scene);
}

TEST(ClosedParts, WhatCountsAsOne) {
  mesh::TriangleSoup sphere = mesh::make_icosphere(glm::dvec3(0), 1, 2);
  const ClosedParts whole = find_closed_parts(floats_of(sphere));
  ASSERT_EQ(whole.parts.size(), 1U);
  EXPECT_EQ(std::ranges::count(whole.part, 1), 320);
  EXPECT_EQ(whole.parts[0].box.upper.y, 1);

  std::swap(sphere.triangles[7][0], sphere.triangles[7][1]);
  EXPECT_EQ(find_closed_parts(floats_of(sphere)).turn, whole.turn) << "winding must not matter";
  // A triangle elsewhere in one of the part's planes: if it is a carrier, the triangle of the part in that plane does
  // not count.
  const auto& [a, b, c] = sphere.triangles[5];
  const glm::dvec3 at = sphere.positions[a];
  const std::vector<tests::Corners> beside{{at, sphere.positions[b], sphere.positions[c]}};
  EXPECT_TRUE(find_closed_parts(floats_of(sphere, beside)).parts.empty());
  sphere.triangles.pop_back();
  EXPECT_TRUE(find_closed_parts(floats_of(sphere)).parts.empty()) << "a hole";
  EXPECT_TRUE(find_closed_parts(floats_of(mesh::make_box(glm::dvec3(0), glm::dvec3(1)))).parts.empty()) << "too small";
}

// A triangle without area casts no shadow, so a T-junction that only it closes leaves the part open.
TEST(ClosedParts, NeedleWithoutAreaOpensItsPart) {
  mesh::TriangleSoup sphere = mesh::make_icosphere(glm::dvec3(0), 1, 2);
  // Positions are on a coarse grid, so that the middle of an edge is exact.
  for (glm::dvec3& position : sphere.positions) position = glm::round(position * 1024.0) / 1024.0;
  ASSERT_EQ(find_closed_parts(floats_of(sphere)).parts.size(), 1U);
  const auto [a, b, c] = sphere.triangles[0];
  const auto middle = static_cast<std::uint32_t>(sphere.positions.size());
  sphere.positions.push_back((sphere.positions[a] + sphere.positions[b]) / 2.0);
  sphere.triangles[0] = {a, middle, c};
  for (const mesh::Triangle& triangle : {mesh::Triangle{middle, b, c}, mesh::Triangle{a, b, middle}}) {
    sphere.triangles.push_back(triangle);
  }
  EXPECT_TRUE(find_closed_parts(floats_of(sphere)).parts.empty());
}

}  // namespace
}  // namespace penumbra::vsm
