// SPDX-License-Identifier: Apache-2.0
// Tests wedges that the device builds: they pass the same exact proofs as the host's, and are hardly looser.

#include "tests/agreement/support.hpp"
#include "tests/property/volumes/wedge_cases.hpp"

#include "mesh/shapes/broken_meshes.hpp"
#include "mesh/shapes/shapes.hpp"
#include "selftest/edge_checks.hpp"
#include "tests/unit/passed.hpp"
#include "tests/unit/shipped_scene.hpp"
#include "volumes/edges/device/facing.shared.h"
#include "volumes/raster/wedge_builder.hpp"

namespace penumbra::volumes {
namespace {

/// A soup and lights over it; not stored relative to a centre, so that lattices stay lattices.
struct Lit {
  Lit(const mesh::TriangleSoup& soup, std::vector<scenes::AreaLight> above) {
    std::vector<tests::Corners> triangles;
    for (const mesh::Triangle& t : soup.triangles) {
      triangles.push_back({soup.positions[t[0]], soup.positions[t[1]], soup.positions[t[2]]});
    }
    tests::add_object(scene, "soup", triangles);
    scene.lights = std::move(above);
    finish();
  }
  explicit Lit(scenes::Scene of) : scene(std::move(of)) { finish(); }

  void finish() {
    floats = visibility::make_scene_floats(scene);
    for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
      lights.push_back(visibility::make_light(scene, i, floats.origin, {}));
    }
  }

  scenes::Scene scene;
  visibility::SceneFloats floats;
  std::vector<visibility::Light> lights;
};

/// A square and a disk light at each place along a path, with a new orientation at each place.
std::vector<scenes::AreaLight> moving(std::size_t frames, double height, double half, double scale = 1) {
  std::vector<scenes::AreaLight> lights;
  for (std::size_t i = 0; i < frames; ++i) {
    const double turn = 0.37 * static_cast<double>(i);
    const glm::dvec3 center =
        scale * glm::dvec3(1.5 * std::sin(turn), height + 0.25 * std::cos(3 * turn), 1.2 * std::cos(turn));
    const glm::dvec3 u = scale * half * glm::dvec3(std::cos(turn), 0, std::sin(turn));
    const glm::dvec3 v = scale * half * glm::dvec3(-std::sin(turn), 0.3, std::cos(turn));
    if (i % 4 == 3) {
      lights.push_back({"disk", scenes::Disk{center, glm::cross(u, v), scale * half}, glm::dvec3(1), false});
    } else {
      lights.push_back(tests::rectangle_light(center, u, v));
    }
  }
  return lights;
}

using WedgeTally = selftest::WedgeTally;

class WedgeBuilderTest : public tests::DeviceTest {
 protected:
  enum class How { like_host, valid, valid_and_like_host };

  /// Compares with the host, for every light. Layers::one_a_solid unless the wedges are to be validated.
  static void expect_sound(const std::string& name, const Lit& stage, How how, WedgeTally& tally) {
    SCOPED_TRACE(name);
    const Layers layers = how == How::like_host ? Layers::one_a_solid : Layers::every_triangle;
    const selftest::Check check =
        selftest::check_wedges(device(), stage.floats, stage.lights, layers, how != How::valid, tally);
    tests::expect_passed(check);
    if (how == How::like_host) return;
    WedgeBuilder builder(device(), {WedgesOn::device, Construction::original, layers});
    builder.prepare_mesh(stage.floats);
    for (const visibility::Light& light : stage.lights) {
      expect_valid(stage, light, light_hull(light), builder.build(light).wedges);
    }
  }

  static void expect_same(const LightVolumes& found, const LightVolumes& expected) {
    ASSERT_EQ(found.edges.size(), expected.edges.size());
    for (std::size_t i = 0; i < expected.edges.size(); ++i) {
      ASSERT_EQ(found.edges[i].a, expected.edges[i].a);
      ASSERT_EQ(found.edges[i].b, expected.edges[i].b);
      ASSERT_EQ(found.edges[i].multiplicity, expected.edges[i].multiplicity);
    }
    ASSERT_EQ(found.caps.size(), expected.caps.size());
    for (std::size_t i = 0; i < expected.caps.size(); ++i) {
      ASSERT_EQ(found.caps[i].corners, expected.caps[i].corners);
      ASSERT_EQ(found.caps[i].plane, expected.caps[i].plane);
    }
    ASSERT_EQ(found.left_out, expected.left_out);
  }

  /// Expects that the wedges pass all checks of `wedges --validate`.
  static void expect_valid(const Lit& stage, const visibility::Light& light, const LightHull& hull,
                           const LightWedges& wedges) {
    const Casters casters = casters_of(stage.floats, light);
    const CastingEdges casting = casting_edges(casters, hull, SilhouettesFrom::center, false);
    ASSERT_EQ(casting.wedges.size(), wedges.edges.size());
    const ValidationReport report = validate({casters, casting, hull, wedges.wedges});
    ASSERT_TRUE(report.violations.empty()) << test::text_of(report.violations.front());
  }

  static void print(const char* what, const WedgeTally& tally) {
    fmt::print("{}: {} edges, {} by the host; {} planes proved\n", what, tally.edges, tally.on_host, tally.planes);
  }
};

mesh::TriangleSoup small_knot(double scale = 1) {
  mesh::KnotShape knot;
  knot.center = {0, 1, 0};
  knot.segments = 100;
  knot.sides = 20;
  mesh::TriangleSoup soup = mesh::make_knot(knot);
  for (glm::dvec3& p : soup.positions) p *= scale;
  return soup;
}

TEST_F(WedgeBuilderTest, ALightThatMovesOverAKnot) {
  WedgeTally tally;
  expect_sound("knot", Lit(small_knot(), moving(20, 5, 0.7)), How::like_host, tally);
  print("20 frames", tally);
  EXPECT_LE(tally.on_host * 100, tally.edges);
}

TEST_F(WedgeBuilderTest, FarFromOneInSize) {
  WedgeTally tally;
  for (const double scale : {0x1p-70, 0x1p-20, 0x1p60}) {
    expect_sound(fmt::format("knot times {}", scale), Lit(small_knot(scale), moving(4, 5, 0.7, scale)), How::like_host,
                 tally);
  }
  print("scales", tally);
  EXPECT_EQ(tally.on_host, 0U);
}

/// Results do not depend on the schedule: a second run, another builder, and buffers that take the wedges in batches
/// give the same bits. If buffers cannot hold the mesh, everything is left to the host.
TEST_F(WedgeBuilderTest, TheSameBitsEveryTime) {
  const Lit stage(mesh::make_lattice_soup({200, 64, 7, glm::dvec3(0), 2}), moving(2, 5, 0.7));
  const std::uint64_t triangles = stage.floats.triangles.size(), enough = triangles * sizeof(gpu::FacingTriangle);
  std::vector<WedgeBuilder> builders;
  for (const std::uint64_t most_bytes :
       {std::uint64_t{0}, std::uint64_t{0}, enough + 32 * sizeof(gpu::FacingTriangle)}) {
    builders.emplace_back(device(), WedgeBuilder::Options{.most_bytes = most_bytes});
    builders.back().prepare_mesh(stage.floats);
  }
  for (const visibility::Light& light : stage.lights) {
    const WedgeBuilder::Built first = builders[0].build(light);
    ASSERT_GT(first.volumes.edges.size() * sizeof(Plane) * 4, 5 * enough);  // otherwise a buffer would hold everything
    for (WedgeBuilder& builder : builders) {
      const WedgeBuilder::Built again = builder.build(light);
      expect_same(again.volumes, first.volumes);
      ASSERT_EQ(again.wedges.wedges.size(), first.wedges.wedges.size());
      for (std::size_t i = 0; i < first.wedges.wedges.size(); ++i) {
        EXPECT_EQ(again.wedges.wedges[i].planes, first.wedges.wedges[i].planes) << i;
      }
      EXPECT_EQ(again.edges_on_host, 0U);
    }
  }
  WedgeBuilder none(device(), {.most_bytes = enough / 2});
  none.prepare_mesh(stage.floats);
  const WedgeBuilder::Built built = none.build(stage.lights[0]);
  EXPECT_EQ(built.edges_on_host, built.wedges.edges.size());
  expect_same(built.volumes, builders[0].build(stage.lights[0]).volumes);
}

TEST_F(WedgeBuilderTest, ShippedScenesAreValid) {
  WedgeTally tally;
  for (const char* name : {"broken", "contact", "fusion", "parallel-square"}) {
    expect_sound(name, Lit(tests::shipped_scene(name)), How::valid_and_like_host, tally);
  }
  print("shipped scenes", tally);
  EXPECT_EQ(tally.on_host, 0U);
}

TEST_F(WedgeBuilderTest, EveryDefectIsValid) {
  WedgeTally tally;
  for (const mesh::DefectName& defect : mesh::broken_defects()) {
    const mesh::BrokenMesh mesh = mesh::make_broken_mesh({{std::string(defect.name)}, 1, {0, 1, 0}, 1});
    expect_sound(std::string(defect.name), Lit(mesh.soup, moving(4, 4, 0.5)), How::valid_and_like_host, tally);
  }
  print("defects", tally);
  EXPECT_GT(tally.planes, 4000U);
}

/// The light is among the triangles: edges touch it, cross it, point at it, lie in its plane. These are left to the
/// host; where an edge only touches the light, the device may prove planes that the host leaves out.
TEST_F(WedgeBuilderTest, LatticeSoupsAroundTheLight) {
  WedgeTally tally;
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    const mesh::TriangleSoup soup = mesh::make_lattice_soup({24, 4, seed, glm::dvec3(0), 2});
    std::vector<scenes::AreaLight> lights = moving(4, 0.5, 0.5);
    lights.push_back(tests::ceiling_light(1, 0.5));
    expect_sound(fmt::format("soup {}", seed), Lit(soup, lights), How::valid, tally);
  }
  print("soups", tally);
  EXPECT_GT(tally.on_host, 100U);
  EXPECT_LT(tally.on_host, tally.edges);
}

}  // namespace
}  // namespace penumbra::volumes
