// SPDX-License-Identifier: Apache-2.0
// Tests maps drawn by Vulkan and by OpenGL: against the triangles in double, against each other, and by the V that
// methods compute from them. Also tests RasterTwin, the rasteriser in double that they are compared with, on triangles
// whose coverage is known.

#include "base/error.hpp"
#include "maps/filters/methods.hpp"
#include "selftest/centre_maps.hpp"
#include "selftest/crowd.hpp"
#include "selftest/raster_twin.hpp"
#include "selftest/rasteriser_checks.hpp"
#include "tests/analytic/maps/fixture.hpp"
#include "tests/unit/passed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <random>

namespace penumbra::tests {
namespace {

using maps::Rasteriser;
using selftest::RasterTwin;
using selftest::Surface;

/// A face [−1, 1]² that looks along z, for a light point at 0.
maps::gpu::CasterPush straight() {
  return {.point = {0, 0, 0},
          .near = 0x1p-20F,
          .row_x = {1, 0, 0},
          .far = 4,
          .row_y = {0, 1, 0},
          .first_vertex = 0,
          .row_w = {0, 0, 1},
          .offset_factor = 0,
          .depth_row = {0, 0, 1},
          .offset_units = 0};
}

// The diagonal of a square passes through the centres of a map's own diagonal texels: these are undecided, all others
// certain.
TEST(RasterTwin, IsSureExceptWithinAStepOfAnEdge) {
  constexpr std::uint32_t kSize = 16;
  const std::vector<glm::vec3> corners{{-2, -2, 2}, {2, -2, 2}, {2, 2, 2}};  // below the diagonal, z / far = 1/2
  for (const double step : {1.0 / 256, 1.0 / 16}) {
    const RasterTwin twin(straight(), kSize, step, corners);
    std::vector<Surface> surfaces;
    for (std::uint32_t y = 0; y < kSize; ++y) {
      for (std::uint32_t x = 0; x < kSize; ++x) {
        twin.find(x, y, surfaces);
        ASSERT_EQ(surfaces.size(), x < y ? 0U : 1U) << x << ", " << y;
        if (x < y) continue;
        EXPECT_EQ(surfaces.front().sure, x > y);
        EXPECT_DOUBLE_EQ(surfaces.front().depth, 0.5);
        EXPECT_LE(surfaces.front().low, 0.5);
        EXPECT_GE(surfaces.front().high, 0.5);
        EXPECT_LT(surfaces.front().high - surfaces.front().low, 1e-4) << "parallel: a step changes nothing";
      }
    }
  }
}

// A wall along x = 1/3 that runs away from the light point to the light's plane and behind it: it is visible where x/z
// > 1/3, at z = 1 / (3 x/z). A step in x/z changes its depth in proportion to the square of the depth.
TEST(RasterTwin, KnowsDepthsOfSurfacesThatCrossTheLightsPlane) {
  constexpr std::uint32_t kSize = 64;
  constexpr double kStep = 1.0 / 256;
  const float third = 1 / 3.0F;
  const std::vector<glm::vec3> corners{{third, -9, -1}, {third, 9, -1}, {third, 0, 30}};
  const RasterTwin twin(straight(), kSize, kStep, corners);
  std::vector<Surface> surfaces;
  std::size_t seen = 0;
  for (std::uint32_t x = 0; x < kSize; ++x) {
    const double tangent = 2 * (x + 0.5) / kSize - 1;
    twin.find(x, kSize / 2, surfaces);
    if (tangent < 1 / 12.0 - 0.01) {
      EXPECT_TRUE(surfaces.empty());  // beyond far, or on the other side
    }
    if (tangent < 1 / 12.0 + 0.01) continue;
    ASSERT_EQ(surfaces.size(), 1U);
    ++seen;
    const Surface& surface = surfaces.front();
    const double depth = static_cast<double>(third) / tangent / 4;
    EXPECT_TRUE(surface.sure);
    EXPECT_NEAR(surface.depth, depth, 1e-12);
    const double moved = depth * (2 * kStep / kSize) / tangent;
    EXPECT_NEAR(surface.high - depth, moved, 0.1 * moved + 1e-5);
  }
  EXPECT_GT(seen, 20U);
}

TEST(RasterTwin, JudgesWhatAMapHolds) {
  const std::vector<Surface> surfaces{{.depth = 0.3, .low = 0.29, .high = 0.31, .sure = true},
                                      {.depth = 0.2, .low = 0.19, .high = 0.21, .sure = false},
                                      {.depth = 0.6, .low = 0.59, .high = 0.61, .sure = true}};
  using selftest::judge_behind, selftest::judge_farthest, selftest::judge_nearest;
  EXPECT_TRUE(judge_nearest(surfaces, 0.3).right);
  EXPECT_TRUE(judge_nearest(surfaces, 0.205).right) << "a surface that may cover this texel is an allowed answer";
  EXPECT_FALSE(judge_nearest(surfaces, 0.6).right) << "behind one that is surely there";
  EXPECT_FALSE(judge_nearest(surfaces, 0.25).right);
  EXPECT_FALSE(judge_nearest(surfaces, 1).right);
  EXPECT_FALSE(judge_nearest(surfaces, 0.3).settled);
  EXPECT_TRUE(judge_behind(surfaces, 0.595, 0.3).right);
  EXPECT_FALSE(judge_behind(surfaces, 0.595, 0.3).settled) << "the nearest may be behind itself";
  EXPECT_TRUE(judge_behind(surfaces, 0.595, 0.32).settled);
  EXPECT_FALSE(judge_behind(surfaces, 1, 0.3).right);
  EXPECT_TRUE(judge_behind(surfaces, 1, 0.605).right);
  EXPECT_TRUE(judge_behind(surfaces, 1, 1).right);
  EXPECT_TRUE(judge_farthest(surfaces, 0.6).right);
  EXPECT_FALSE(judge_farthest(surfaces, 0.3).right);
  EXPECT_FALSE(judge_farthest(surfaces, 0).right);
  EXPECT_TRUE(judge_farthest({}, 0).right);
  EXPECT_TRUE(judge_nearest({}, 1).right);
  EXPECT_TRUE(std::isinf(selftest::largest_disagreement(surfaces, false)));
  EXPECT_NEAR(selftest::largest_disagreement(surfaces, true), 0.02, 1e-12);
}

/// Makes a crowd with loose triangles among its objects.
scenes::Scene crowd_with_needles(bool wall, bool two_sided) {
  scenes::Scene scene = selftest::crowd(wall, two_sided);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> draw(-1, 1);
  const auto point = [&] { return glm::dvec3(1.8 * draw(random), 1.2 + draw(random), 1.8 * draw(random)); };
  std::vector<Corners> loose;
  for (int i = 0; i < 24; ++i) {
    const glm::dvec3 a = point(), b = point();
    loose.push_back({a, b, i % 2 == 0 ? point() : b + 0.004 * point()});  // every other one a needle
  }
  add_object(scene, "loose", loose);
  return scene;
}

class MapsRasterisers : public MapsTest {};

TEST_F(MapsRasterisers, EachDrawsWhatItMust) {
  for (const auto& [wall, two_sided] : {std::pair(false, false), std::pair(true, false), std::pair(false, true)}) {
    const Stage stage(crowd_with_needles(wall, two_sided), 4, 4, light_samples(1));
    for (const std::uint32_t size : {8U, 33U, 64U}) {
      SCOPED_TRACE(fmt::format("wall {}, two-sided {}, size {}", wall, two_sided, size));
      for (const Rasteriser rasteriser : {Rasteriser::vulkan, Rasteriser::opengl}) {
        const selftest::Check check = selftest::check_maps(device(), stage, size, rasteriser);
        expect_passed(check);
        fmt::print("{}, size {}: {} of {} off, at most {:.2g} of {:.2g}\n", check.pass, size, check.differing,
                   check.compared, check.largest, check.allowed);
      }
      const selftest::Check both = selftest::check_rasterisers_agree(device(), stage, size);
      expect_passed(both);
      fmt::print("both, size {}: {} of {} differ\n", size, both.differing, both.compared);
    }
  }
}

struct Named {
  const char* name;
  Factory factory;
  visibility::MethodOptions options;
};

/// Returns every method of maps/, with small maps.
std::vector<Named> every_method() {
  return {{"shadow-map", maps::make_shadow_map, {{"depth", "midpoint"}}},
          {"pcf", maps::make_pcf, {}},
          {"silhouette-map", maps::make_silhouette_map, {}},
          {"forward-map", maps::make_forward_map, {}},
          {"pcss", maps::make_pcss, {}},
          {"vssm", maps::make_vssm, {}},
          {"convolution", maps::make_convolution, {}},
          {"occlusion-textures", maps::make_occlusion_textures, {}},
          {"backproject", maps::make_backproject, {}},
          {"backproject-peel", maps::make_backproject_peel, {}},
          {"bitmask", maps::make_bitmask, {}},
          {"layer-rays", maps::make_layer_rays, {}},
          {"penumbra-map", maps::make_penumbra_map, {}},
          {"smoothies", maps::make_smoothies, {}},
          {"brabec-seidel", maps::make_brabec_seidel, {}},
          {"kirsch-doellner", maps::make_kirsch_doellner, {}},
          {"parker", maps::make_parker, {}},
          {"arvo", maps::make_arvo, {}},
          {"contour", maps::make_contour, {}},
          {"packet", maps::make_packet, {}},
          {"soft-shadow-map", maps::make_soft_shadow_map, {{"passes", "2"}, {"receiverSize", "32"}}},
          {"accumulate", maps::make_accumulate, {}},
          {"adaptive-light", maps::make_adaptive_light, {}},
          {"deep-penumbra", maps::make_deep_penumbra, {}},
          {"layered-attenuation", maps::make_layered_attenuation, {}}};
}

// V is a function of the maps: for the same texels it is the same in every bit. Mesa's two drivers are one rasteriser
// with two compilers; they cover the same texels, and depths differ in the last bit. That changes a depth test only
// where a receiver lies within a rounding (10⁻⁷ of the depth) of its threshold, and in these maps thresholds are spread
// over 10⁻⁴ of the depth and more: so fewer than one tap in a thousand changes, and V changes by less than a thousandth
// in the mean.
TEST_F(MapsRasterisers, EveryMethodGivesTheSameVOfTheSameMaps) {
  const Stage stage(crowd_with_needles(false, false), 24, 24, light_samples(16));
  const selftest::Check texels = selftest::check_rasterisers_agree(device(), stage, 32);
  for (const Named& method : every_method()) {
    SCOPED_TRACE(method.name);
    visibility::MethodOptions options = method.options;
    options["size"] = "32";
    const Masks vulkan = run(method.factory, stage, options);
    options["rasteriser"] = "opengl";
    const Masks opengl = run(method.factory, stage, options), again = run(method.factory, stage, options);
    EXPECT_EQ(opengl.visibility, again.visibility);
    EXPECT_EQ(opengl.words, again.words);
    std::size_t shaded = 0;
    double worst = 0, sum = 0;
    for (std::size_t i = 0; i < vulkan.visibility.size(); ++i) {
      shaded += opengl.visibility[i] < 1 ? 1 : 0;
      const double off =
          std::abs(static_cast<double>(opengl.visibility[i]) - static_cast<double>(vulkan.visibility[i]));
      worst = std::max(worst, off);
      sum += off;
    }
    EXPECT_GT(shaded, 20U);
    fmt::print("{}: V differs by at most {:.4f}, {:.5f} in the mean\n", method.name, worst,
               sum / static_cast<double>(vulkan.visibility.size()));
    if (texels.differing == 0) {
      EXPECT_EQ(opengl.visibility, vulkan.visibility);
      EXPECT_EQ(opengl.words, vulkan.words);
    } else if (texels.largest < 1e-6) {  // both rasterisers covered the same texels
      EXPECT_LE(sum, 1e-3 * static_cast<double>(vulkan.visibility.size()));
    }
  }
}

TEST_F(MapsRasterisers, MapsThatOpenGlCannotHaveAreRefused) {
  const std::uint32_t most = device().opengl().info().max_image_size;
  EXPECT_GE(most, 16384U);
  EXPECT_THROW(maps::OpenGlMaps(device().opengl(), most + 1), ResourceError);
  try {
    maps::make_shadow_map(device(), {{"rasteriser", "software"}});
    ADD_FAILURE();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("vulkan"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace penumbra::tests
