// SPDX-License-Identifier: Apache-2.0
// Tests maps and products made from them against a few lines of C++: the depths of two planes, and products against
// their twins on maps read back from the device.

#include "maps/host/caster.frag.spv.hpp"
#include "maps/host/caster.vert.spv.hpp"
#include "maps/products/nearest_caster.hpp"
#include "selftest/map_checks.hpp"
#include "tests/analytic/maps/centre_maps.hpp"
#include "tests/unit/passed.hpp"

#include <array>
#include <tuple>

namespace penumbra::tests {
namespace {

constexpr std::uint32_t kMapTexels = 64;

/// A floor below, a sphere between floor and light, and for a two-sided light a ceiling above with a board below it.
scenes::Scene scene_around(bool two_sided, double wall_height) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, -3});
  add_object(scene, "sphere", sphere({0.3, 1, 0.2}, 0.5, 8));
  if (wall_height > 0) add_quad(scene, {3, wall_height / 2, 0}, {0, wall_height / 2, 0}, {0, 0, 3});
  if (two_sided) {
    add_quad(scene, {0, 8, 0}, {3, 0, 0}, {0, 0, 3});
    add_quad(scene, {0.5, 6.5, 0}, {0.5, 0, 0}, {0, 0, 0.5});
  }
  scene.lights.push_back(ceiling_light(5, 0.5));
  scene.lights.back().two_sided = two_sided;
  scene.cameras.push_back(camera({0, 3, 8}, {0, 1, 0}));
  return scene;
}

class MapsProducts : public MapsTest {};

TEST_F(MapsProducts, NearestCasterIsItsTwinInWindowsAndHemicubesOnBothSides) {
  for (const auto& [two_sided, wall] :
       {std::tuple(false, 0.0), std::tuple(false, 5.0), std::tuple(true, 0.0), std::tuple(true, 6.0)}) {
    const Stage stage(scene_around(two_sided, wall), 4, 4, light_samples(1));
    const CentreMaps maps(device(), stage, kMapTexels);
    ASSERT_EQ(maps.fitted.faces, (wall > 0 ? 5U : 1U) + (two_sided ? (wall > 5 ? 5U : 1U) : 0U));
    expect_passed(selftest::check_nearest_caster(device(), stage, kMapTexels));
    maps::NearestCaster product(device());
    render::Commands commands(device());
    product.record(commands, maps.set(stage));
    commands.submit();
    std::array<float, 2> found{};
    product.buffer().read<float>(found);
    EXPECT_LT(found[0], 5) << "the sphere is seen";
    EXPECT_EQ(found[1] < 5, two_sided);
  }
}

TEST_F(MapsProducts, NearestIdsAreOfTrianglesThatMayBeNearest) {
  for (const auto& [two_sided, wall] : {std::tuple(false, 0.0), std::tuple(true, 6.0)}) {
    const Stage stage(scene_around(two_sided, wall), 4, 4, light_samples(1));
    expect_passed(selftest::check_nearest_ids(device(), stage, kMapTexels, maps::Rasteriser::vulkan));
  }
}

// A receiver far smaller than the light: its casters are outside all directions in which the light's centre sees the
// receiver.
TEST_F(MapsProducts, PcssSeesCastersBesideTheReceiversOwnDirections) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {0.05, 0, 0}, {0, 0, -0.05});
  // At half the light's height, from x = 0.3 on: it hides the light from x = 0.6 on.
  add_quad(scene, {4.3, 1, 0}, {4, 0, 0}, {0, 0, -4}).receives_shadow = false;
  scene.lights.push_back(ceiling_light(2, 1));
  scene.cameras.push_back(camera({0, 0.5, 0.5}, {0, 0, 0}, 20));
  const Stage stage(scene, 16, 16, light_samples(1));
  const Masks result =
      run(maps::make_pcss, stage, {{"size", "256"}, {"blockerSamples", "1024"}, {"filterSamples", "1024"}});
  std::size_t receivers = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (stage.samples.triangle[i] < 0 || stage.samples.triangle[i] > 1) continue;
    ++receivers;
    // Seen from p, the light is hidden from x = 2 · 0.3 − p.x on. The share of n evenly spread points beside a line is
    // off by at most log₂ n / n. The window is no wider than the receiver (0.05) and pcss's taps beside it (half the
    // light's side over the radius of a disk of its area, 0.886, on each side): 1.83 in 254 texels at the board's
    // height 1. So half a texel moves the board's edge by 0.0036, its shadow on the light by twice that, and V, for a
    // light 2 wide, by 0.0036.
    const double x = stage.floats.origin.x + static_cast<double>(stage.samples.p[i].x);
    const double exact = (1 + 0.6 - x) / 2;
    EXPECT_NEAR(static_cast<double>(result.visibility[i]), exact, 10.0 / 1024 + 0.0036);
  }
  EXPECT_GT(receivers, 20U);
}

/// Two parallel quads that fill the window, with opposite windings.
class TwoPlanes : public MapsTest {
 protected:
  static constexpr float kNear = 1, kFar = 2, kScene = 4;

  /// Returns the depth of all texels, times kScene, or -1 if they differ.
  float depth(render::DepthCompare compare, render::Cull cull) {
    const render::RasterPass pass(device(), {.name = "planes",
                                             .vertex = shaders::kCasterVert,
                                             .fragment = shaders::kCasterFrag,
                                             .push_bytes = sizeof(maps::gpu::CasterPush),
                                             .constants = {},
                                             .depth = true,
                                             .compare = compare,
                                             .cull = cull});
    std::vector<glm::vec3> corners;
    for (const float z : {kNear, kFar}) {
      const float turn = z == kNear ? 1.0F : -1.0F;
      const glm::vec3 a(-9 * turn, -9, z), b(9 * turn, -9, z), c(9 * turn, 9, z), d(-9 * turn, 9, z);
      corners.insert(corners.end(), {a, b, c, a, c, d});
    }
    const render::Buffer triangles = render::make_buffer<glm::vec3>(device(), "planes", corners);
    const render::DepthTarget target(device(), "planes", kMapTexels, kMapTexels);
    render::Buffer depths(device(), "depths", std::uint64_t{kMapTexels} * kMapTexels * sizeof(float));
    const maps::gpu::CasterPush push{.point = {0, 0, 0},
                                     .near = 0x1p-20F,
                                     .row_x = {1, 0, 0},
                                     .far = kScene,
                                     .row_y = {0, 1, 0},
                                     .first_vertex = 0,
                                     .row_w = {0, 0, 1},
                                     .offset_factor = 0,
                                     .depth_row = {0, 0, 1},
                                     .offset_units = 0};
    render::Commands commands(device());
    pass.record(commands, push, {triangles},
                {.width = kMapTexels, .height = kMapTexels, .vertices = 12, .depth = &target});
    target.copy_to(commands, depths);
    commands.submit();
    std::vector<float> texels(std::size_t{kMapTexels} * kMapTexels);
    depths.read<float>(texels);
    const bool same = std::ranges::all_of(texels, [&](float texel) { return texel == texels.front(); });
    return same ? texels.front() * kScene : -1;
  }
};

TEST_F(TwoPlanes, TheDepthTestKeepsTheNearestOrTheFarthest) {
  EXPECT_EQ(depth(render::DepthCompare::less, render::Cull::none), kNear);
  EXPECT_EQ(depth(render::DepthCompare::greater, render::Cull::none), kFar);
}

TEST_F(TwoPlanes, CullingLeavesOneSideOut) {
  // The nearer plane's corners run clockwise as seen with y down: its back is visible.
  EXPECT_EQ(depth(render::DepthCompare::less, render::Cull::back), kFar);
  EXPECT_EQ(depth(render::DepthCompare::less, render::Cull::front), kNear);
  EXPECT_EQ(depth(render::DepthCompare::greater, render::Cull::back), kFar);
  EXPECT_EQ(depth(render::DepthCompare::greater, render::Cull::front), kNear);
}

}  // namespace
}  // namespace penumbra::tests
