// SPDX-License-Identifier: Apache-2.0
// `wedges --validate` as a library: every mesh and every kind of light passes; every fault is caught.

#include "mesh/shapes/broken_meshes.hpp"
#include "scenes/formats/reader.hpp"
#include "tests/property/volumes/wedge_cases.hpp"
#include "volumes/wedges/wedge_faults.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <filesystem>

namespace penumbra::volumes {
namespace {

using test::expect_valid;
using test::lights_at;
using test::Total;
using test::validated;

const std::filesystem::path kScenes = PENUMBRA_SCENES;

mesh::TriangleSoup soup_of(std::vector<glm::dvec3> positions, std::vector<mesh::Triangle> triangles) {
  mesh::TriangleSoup soup{std::move(positions), std::move(triangles), {}, {}};
  soup.object.assign(soup.triangles.size(), 0);
  return soup;
}

struct Loaded {
  visibility::Light light;
  LightHull hull;
  Casters casters;
};

Loaded shipped(const std::string& name) {
  const scenes::Scene scene = scenes::read_scene(kScenes / (name + ".json"));
  const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
  Loaded loaded{visibility::make_light(scene, 0, floats.origin, {}), {}, {}};
  loaded.hull = light_hull(loaded.light);
  loaded.casters = casters_of(floats, loaded.light);
  return loaded;
}

TEST(WedgeValidation, SmallShippedScenes) {
  for (const char* name : {"parallel-square", "broken"}) {
    const Loaded scene = shipped(name);
    EXPECT_GT(expect_valid(scene.casters, scene.hull, name).wedges, 10U);
  }
}

TEST(WedgeValidation, ShippedScenesFull) {
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() != ".json" || name.ends_with(".schema")) continue;
    const Loaded scene = shipped(name);
    const Total total = expect_valid(scene.casters, scene.hull, name);
    fmt::print("{}: {} wedges, {} planes, {} crops\n", name, total.wedges, total.planes, total.crops);
    EXPECT_GT(total.wedges, 10U);
  }
}

TEST(WedgeValidation, EveryDefectUnderEveryLight) {
  Total total;
  for (const mesh::DefectName& defect : mesh::broken_defects()) {
    const Casters casters = casters_of(mesh::make_broken_mesh({{std::string(defect.name)}, 1, {0, 1, 0}, 1}).soup);
    for (const visibility::Light& light : lights_at({0.3, 4, 0.1}, 0.5)) {
      const Total some = expect_valid(casters, light_hull(light), fmt::format("{} under {}", defect.name, light.name));
      total.wedges += some.wedges;
      total.crops += some.crops;
    }
  }
  EXPECT_GT(total.wedges, 1000U);
  EXPECT_GT(total.crops, 10U);
}

TEST(WedgeValidation, AllDefectsTogetherFull) {
  std::vector<std::string> all;
  for (const mesh::DefectName& defect : mesh::broken_defects()) all.emplace_back(defect.name);
  for (const std::uint32_t size : {1u, 2u, 4u, 16u}) {
    const Casters casters = casters_of(mesh::make_broken_mesh({all, size, {0, 1, 0}, 4}).soup);
    for (const visibility::Light& light : lights_at({0.3, 6, 0.1}, 1)) {
      expect_valid(casters, light_hull(light), fmt::format("all, size {}, under {}", size, light.name));
    }
  }
}

/// Soups on a lattice, with the light among the triangles: edges touch it, cross it, point at it, lie in its plane.
TEST(WedgeValidation, LatticeSoupsAroundTheLight) {
  std::array<std::size_t, 4> outcomes{};
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    const Casters casters = casters_of(mesh::make_lattice_soup({12, 4, seed, glm::dvec3(0), 2}));
    LightHull light{{{-0.5, 1, -0.5}, {0.5, 1, -0.5}, {0.5, 1, 0.5}, {-0.5, 1, 0.5}}, {0, 1, 0}, 0, false};
    expect_valid(casters, light, fmt::format("lattice soup, seed {}", seed));
    const auto result = validated(casters, light, Construction::original, SilhouettesFrom::anywhere);
    for (const Wedge& wedge : result.wedges) ++outcomes[static_cast<std::size_t>(wedge.outcome)];
  }
  fmt::print("original: {} wedges, {} split, {} everywhere\n", outcomes[0], outcomes[1], outcomes[2]);
  for (const std::size_t count : {outcomes[0], outcomes[1], outcomes[2]}) EXPECT_GT(count, 10U);
}

/// Every mistake is found, by the invariant that it breaks.
TEST(WedgeValidation, EveryFaultIsCaught) {
  const Loaded scene = shipped("broken");
  const CastingEdges casting = casting_edges(scene.casters, scene.hull, SilhouettesFrom::center, false);
  for (int number = 1; number <= 6; ++number) {
    const std::vector<Wedge> wedges = build_faulty_wedges(casting.wedges, scene.hull, static_cast<Fault>(number));
    const ValidationReport report = validate({scene.casters, casting, scene.hull, wedges});
    ASSERT_FALSE(report.violations.empty()) << "broken:" << number;
    const Violation& first = report.violations[0];
    ASSERT_TRUE(first.wedge) << "broken:" << number;
    if (number == 6) {
      EXPECT_EQ(first.invariant, Invariant::cover);
      continue;
    }
    EXPECT_EQ(first.invariant, Invariant::conservative) << "broken:" << number;
    ASSERT_TRUE(first.plane) << "broken:" << number;
    EXPECT_GT(first.distance, 0) << "broken:" << number;
  }
}

/// The construction must split an edge that points at the light, away from the light's middle.
TEST(WedgeValidation, APlaneOfAnUnsplitEdgeIsCaught) {
  const Casters casters = casters_of(soup_of({{0.25, 3.9, 0}, {0.25, -3, 0}, {2, 0, 1}}, {{0, 1, 2}}));
  const LightHull light{{{-1, 4, -1}, {1, 4, -1}, {1, 4, 1}, {-1, 4, 1}}, {0, 4, 0}, 0, false};
  expect_valid(casters, light, "an edge that points at the light");
  const CastingEdges casting = casting_edges(casters, light, SilhouettesFrom::anywhere, false);
  const std::vector<Wedge> sound = build_wedges(casting.wedges, light, Construction::original);
  EXPECT_NE(std::ranges::find(sound, WedgeOutcome::split, &Wedge::outcome), sound.end());
  const std::vector<Wedge> wedges = build_faulty_wedges(casting.wedges, light, Fault::split_missing);
  const ValidationReport report = validate({casters, casting, light, wedges});
  ASSERT_FALSE(report.violations.empty());
  EXPECT_EQ(report.violations[0].invariant, Invariant::conservative);
}

TEST(WedgeValidation, WhatElseMayBeWrong) {
  const Loaded scene = shipped("parallel-square");
  const auto good = validated(scene.casters, scene.hull, Construction::tight, SilhouettesFrom::anywhere);
  ASSERT_TRUE(good.report.violations.empty());
  const auto caught = [&](Invariant invariant, const auto& spoil) {
    std::vector<Wedge> wedges = good.wedges;
    spoil(wedges);
    const ValidationReport report = validate({scene.casters, good.casting, scene.hull, wedges, true});
    return std::ranges::find(report.violations, invariant, &Violation::invariant) != report.violations.end();
  };
  using List = std::vector<Wedge>&;
  EXPECT_TRUE(caught(Invariant::numbers, [](List w) { w[0].planes[0] = {0, 0, 0, 1}; }));
  EXPECT_TRUE(caught(Invariant::numbers, [](List w) { w[0].planes[0].a = std::numeric_limits<double>::quiet_NaN(); }));
  EXPECT_TRUE(caught(Invariant::cover, [](List w) { w.pop_back(); }));
  EXPECT_TRUE(caught(Invariant::cover, [](List w) { w[0].b.x += 1e-9; }));
  EXPECT_TRUE(caught(Invariant::outcome, [](List w) { w[0].planes.clear(); }));
  EXPECT_TRUE(caught(Invariant::outcome, [](List w) {
    w[0].outcome = WedgeOutcome::everywhere;
    w[0].planes.clear();
  }));
  EXPECT_TRUE(caught(Invariant::outcome, [](List w) {
    w[0].outcome = WedgeOutcome::empty;
    w[0].planes.clear();
  }));
  EXPECT_TRUE(caught(Invariant::polyhedron, [](List w) { w.back().planes.push_back({0, 1, 0, -100}); }));
}

/// A cube under a light all of which sees its top and a part of which sees one side: that edge's wedge is cropped, the
/// crop is proved, and the same plane the other way round is refused.
TEST(WedgeValidation, CropsAreProved) {
  const mesh::TriangleSoup cube = mesh::make_broken_mesh({{"none"}, 1, {0, 0, 0}, 0.5}).soup;
  const Casters casters = casters_of(cube);
  const LightHull light{{{0, 3, -0.5}, {1, 3, -0.5}, {1, 3, 0.5}, {0, 3, 0.5}}, {0.5, 3, 0}, 0, false};
  auto result = validated(casters, light, Construction::tight, SilhouettesFrom::anywhere);
  ASSERT_TRUE(result.report.violations.empty()) << test::text_of(result.report.violations[0]);
  ASSERT_GT(result.report.cropped_planes, 0U);
  for (Wedge& wedge : result.wedges) {
    for (Plane& crop : result.casting.wedges[wedge.source].crop) {
      Plane& plane = wedge.planes.back();
      plane = crop = {-plane.a, -plane.b, -plane.c, -plane.d};
    }
  }
  const ValidationReport report = validate({casters, result.casting, light, result.wedges, true});
  EXPECT_GE(report.violations.size(), result.report.cropped_planes);
}

/// The lights' stored samples lie within the hull, because their extents along many directions do.
TEST(WedgeValidation, HullsHoldTheirLights) {
  for (const glm::dvec3& center : {glm::dvec3(0.3, 4, 0.1), glm::dvec3(1000, -300, 20)}) {
    for (const visibility::Light& light : lights_at(center, 0.125)) {
      const LightHull hull = light_hull(light);
      for (int i = 0; i < 400; ++i) {
        const glm::dvec3 n(std::cos(i), std::sin(i), std::cos(0.7 * i));
        double reach = -1e300, inner = -1e300;
        for (const glm::dvec3& corner : hull.corners) reach = std::max(reach, glm::dot(n, corner - hull.center));
        std::vector<glm::vec3> points(light.sample_count());
        visibility::light_points_for(light, glm::vec3(center + 5.0 * n), points.data());
        for (const glm::vec3& point : points) inner = std::max(inner, glm::dot(n, glm::dvec3(point) - hull.center));
        // By their rounding, stored points may be off the plane of a flat light, or outside a corner of a rectangle.
        EXPECT_LE(inner, reach + 0x1p-22 * (glm::length(center) + 1)) << light.name;
      }
    }
  }
}

/// The penumbra of an edge is convex, so tight wedges are no larger. Normals are turned by at most 2⁻²⁰, and a section
/// is at most 2⁶ of such turns away from its edge, in a penumbra at least 2⁻² wide.
TEST(WedgeTightness, TightWedgesAreThePenumbra) {
  const Loaded scene = shipped("broken");
  for (const Construction construction : {Construction::tight, Construction::original}) {
    const auto result = validated(scene.casters, scene.hull, construction, SilhouettesFrom::center);
    const Tightness tightness = tightness_of(result.wedges, scene.hull, scene.hull.corners);
    ASSERT_GT(tightness.ratios.size(), 100U);
    EXPECT_GT(tightness.ratios.front(), 1 - 0x1p-12);
    if (construction == Construction::tight) {
      EXPECT_LT(tightness.ratios.back(), 1 + 0x1p-12);
    } else {
      EXPECT_GT(tightness.ratios.back(), 1.1);
    }
  }
}

}  // namespace
}  // namespace penumbra::volumes
