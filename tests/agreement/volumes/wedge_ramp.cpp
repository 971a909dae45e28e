// SPDX-License-Identifier: Apache-2.0
// Compares wedge-ramp with its C++ twin: the exact count and the ramps of all edges. Tolerance: that of
// soft_volume_twin.cpp.

#include "tests/agreement/volumes/soft_stage.hpp"

#include "volumes/soft/ramp_wedges.hpp"
#include "volumes/soft/methods.hpp"

namespace penumbra::volumes {
namespace {

using tests::Errors;
using tests::SoftStage;

class WedgeRamp : public tests::DeviceTest {};

TEST_F(WedgeRamp, IsItsTwin) {
  for (const char* name : {"parallel-square", "fusion", "room"}) {
    const SoftStage stage(tests::shipped_scene(name), device(), 48, 36);
    const auto method = make_wedge_ramp(device(), {});
    const std::vector<float> found = stage.run(*method);
    const Casters casters = casters_of(stage.floats, stage.light);
    const SoftVisibility soft(stage.floats, stage.light, casters);
    const ShadowCasters shadow(stage.floats, Layers::one_a_solid);
    const glm::vec3 center = visibility::center_of(stage.light);
    const LightWedges wedges = ramp_wedges_of(shadow.seen_from(center, stage.light), stage.light);
    const std::vector<double> expected = stage.at_judged([&](std::size_t i) {
      const LayerSum layers = soft.at(stage.lit(i), Viewer::center);
      if (layers.moved) return std::numeric_limits<double>::quiet_NaN();
      return std::clamp(1 - layers.constant - ramp_sum(wedges, stage.light, stage.samples.p[i]), 0.0, 1.0);
    });
    const Errors errors = tests::errors_of(found, expected);
    fmt::print("{}: {} pixels, {} in penumbra, off by {:.1e} at most\n", name, errors.pixels, errors.penumbra,
               errors.largest);
    EXPECT_LE(errors.largest, 0x1p-25 + 0x1p-33 * static_cast<double>(wedges.edges.size()) + 1e-10) << name;
    EXPECT_GT(errors.penumbra, 10U) << name;
    EXPECT_EQ(stage.run(*method, 5), found) << name << " in tiles";
  }
}

/// The ramp equals the area under the middle of a long edge that runs along the light, with front and back at equal
/// angles.
TEST_F(WedgeRamp, IsExactUnderALongEdge) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  tests::add_object(scene, "board", tests::quad({10, 2, 0}, {10, 0, 0}, {0, 0, -10}));
  scene.lights.push_back(tests::ceiling_light(4, 0.5));
  scene.cameras.push_back(tests::camera({0, 1.5, 0.2}, {0, 0, 0}, 40));
  const SoftStage stage(scene, device(), 48, 36);
  const std::vector<double> exact = stage.exact();
  const Errors errors = tests::errors_of(stage.run(*make_wedge_ramp(device(), {})), exact);
  fmt::print("a long edge: {} in penumbra, off by {:.1e} at most\n", errors.penumbra, errors.largest);
  EXPECT_LE(errors.largest, 1e-6);
  EXPECT_GT(errors.penumbra, 500U);
}

/// View samples on an edge of their own triangle, where the wedge has no width: nothing is in front of the light, so it
/// is visible. (Front and back are both 0 there, and their quotient is NaN.)
TEST_F(WedgeRamp, OnAnEdgeTheShadowIsHard) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", {{glm::dvec3(2, 0, 2), glm::dvec3(2, 0, 0), glm::dvec3(-2, 0, -2)}});
  scene.lights.push_back(tests::ceiling_light(5, 1));
  scene.cameras.push_back(tests::camera({0, 1, 0}, {0, 0, 0}, 90));
  scene.cameras.back().up = {0, 0, -1};
  const SoftStage stage(scene, device(), 16, 16);
  std::size_t on_edge = 0;
  const std::vector<float> v = stage.run(*make_wedge_ramp(device(), {}));
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (!stage.judged(i)) continue;
    on_edge += stage.samples.p[i].x == stage.samples.p[i].z ? 1 : 0;
    EXPECT_EQ(v[i], 1.0F) << i;
  }
  EXPECT_GE(on_edge, 4U);
}

TEST_F(WedgeRamp, RefusesWhatItCannotDo) {
  EXPECT_THROW(static_cast<void>(make_wedge_ramp(device(), {{"split", "2"}})), UsageError);
  EXPECT_THROW(
      static_cast<void>(
          SoftStage(tests::shipped_scene("textured-light"), device(), 8, 8).run(*make_wedge_ramp(device(), {}))),
      InputError);
}

/// One ramp for each edge fails at corners, where it is not the area, and on meshes with triangles smaller than their
/// penumbra.
TEST_F(WedgeRamp, ItsFailuresAreShown) {
  for (const auto& [name, least] : {std::pair{"parallel-square", 0.01}, {"bunny", 0.05}}) {
    const SoftStage stage(tests::shipped_scene(name), device(), 48, 36);
    const Errors errors = tests::errors_of(stage.run(*make_wedge_ramp(device(), {})), stage.exact());
    fmt::print("{}: RMSE {:.3f}, at most {:.2f}\n", name, errors.rmse(), errors.largest);
    EXPECT_GT(errors.rmse(), least) << name;
  }
}

}  // namespace
}  // namespace penumbra::volumes
