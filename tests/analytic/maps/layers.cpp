// SPDX-License-Identifier: Apache-2.0
// Tests layers of a map: the surfaces that depth peeling finds, against every triangle at every texel in double, and
// how the option `depth` uses the first two.

#include "maps/filters/methods.hpp"
#include "selftest/rasteriser_checks.hpp"
#include "tests/analytic/maps/centre_maps.hpp"
#include "tests/analytic/maps/parallel_square.hpp"
#include "tests/unit/passed.hpp"

#include <algorithm>
#include <set>
#include <span>

namespace penumbra::tests {
namespace {

/// Boards at several heights, some of them twice, and a sphere, over a floor that casts, too.
scenes::Scene stacked() {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, -3});
  add_object(scene, "sphere", sphere({0.4, 1, 0.3}, 0.7, 6));
  add_quad(scene, {-0.6, 2.5, 0.2}, {1, 0.3, 0}, {0, 0.1, 0.9});
  add_quad(scene, {0.3, 3, -0.3}, {0.6, -0.1, 0.2}, {0, 0, 0.8});
  add_quad(scene, {0.3, 3, -0.3}, {-0.6, 0.1, -0.2}, {0, 0, 0.8});  // again, with the opposite winding
  scene.lights.push_back(ceiling_light(5, 0.5));
  scene.cameras.push_back(camera({0, 3, 8}, {0, 1, 0}));
  return scene;
}

class MapsLayers : public MapsTest {};

TEST_F(MapsLayers, EachHoldsTheNextSurfaceAndTheFarthestTheLast) {
  const Stage stage(stacked(), 4, 4, light_samples(1));
  constexpr std::uint32_t kSize = 48, kLayers = 4;
  const CentreMaps maps(device(), stage, kSize, {0, 0}, {.layers = kLayers, .farthest = true});
  ASSERT_EQ(maps.fitted.faces, 1U);
  expect_passed(selftest::check_maps(device(), stage, kSize, maps::Rasteriser::vulkan));
  const std::vector<float> texels = maps.read();
  for (std::uint32_t layer = 0; layer <= kLayers; ++layer) {
    const auto held = std::span(texels).subspan(std::size_t{layer} * kSize * kSize, std::size_t{kSize} * kSize);
    EXPECT_GT(std::ranges::count_if(held, [](float depth) { return depth > 0 && depth < 1; }), 20) << layer;
  }
}

// An open sheet over a floor that casts nothing: the sheet has no second surface.
TEST_F(MapsLayers, AnOpenSheetCastsNothingByItsSecondSurfaceAndTheSameByAllOthers) {
  scenes::Scene scene = parallel_square();
  scene.objects[0].casts_shadow = false;
  const Stage stage(scene, 32, 32, light_samples(1));
  const ParallelSquare exact(stage);
  for (const Factory& factory :
       {Factory(maps::make_shadow_map), Factory(maps::make_pcf), Factory(maps::make_pcss),
        Factory(maps::make_backproject), Factory(maps::make_vssm), Factory(maps::make_convolution),
        Factory(maps::make_occlusion_textures), Factory(maps::make_soft_shadow_map)}) {
    const auto with = [&](const char* depth) { return run(factory, stage, {{"size", "64"}, {"depth", depth}}); };
    const Masks first = with("first"), second = with("second"), midpoint = with("midpoint"), dual = with("dual");
    EXPECT_EQ(first.visibility, midpoint.visibility);
    EXPECT_EQ(first.visibility, dual.visibility);
    std::size_t shaded = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!exact.on_floor(i)) continue;
      EXPECT_EQ(second.visibility[i], 1);
      shaded += first.visibility[i] < 1 ? 1 : 0;
    }
    EXPECT_GT(shaded, 50U);
  }
}

/// A slab between heights 0.1 and 2.1 over a floor at 0, and view samples in a column through it: for each use of the
/// depths the shadow must begin where the option says.
TEST_F(MapsLayers, AThickCasterBeginsToShadeWhereTheOptionSays) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -2});
  add_quad(scene, {0, 2.1, 0}, {1, 0, 0}, {0, 0, -1}).receives_shadow = false;
  add_quad(scene, {0, 0.1, 0}, {1, 0, 0}, {0, 0, -1}).receives_shadow = false;
  add_quad(scene, {0, 1, 0}, {0.5, 0, 0}, {0, 0, -0.5}).casts_shadow = false;  // carries the samples
  scene.lights.push_back(ceiling_light(5, 0.5));
  scene.cameras.push_back(camera({0, 3, 3}, {0, 0, 0}));
  constexpr std::uint32_t kSide = 64;
  const auto column = [&](const visibility::SceneFloats& floats, const visibility::PinholeCamera& /*camera*/) {
    visibility::ViewSamples samples;
    samples.width = 1;
    samples.height = kSide;
    for (std::uint32_t i = 0; i < kSide; ++i) {
      const double height = 2.4 * (i + 0.5) / kSide;
      samples.triangle.push_back(6);
      samples.p.emplace_back(glm::dvec3(0.1, height, 0.05) - floats.origin);
      samples.n.emplace_back(0, 1, 0);
      samples.depth.push_back(1);
      samples.facing.push_back(1);
    }
    return samples;
  };
  const Stage stage(scene, 1, kSide, light_samples(1), column);
  // With the light at 5, surfaces are at depths 2.9 and 4.9, their middle at 3.9. The window holds the floor, ±2 / 5,
  // and what stands above it. A texel is at most 4.2 / 5 / 62 wide, so a bias of 8 is 8 · 0.0135 · z, 0.32 … 0.35
  // around z = 3.2.
  // vssm subtracts the bias from the receiver's depth, and the same amount from depths that need no bias: for a level
  // receiver the result is the same.
  for (const Factory& factory : {Factory(maps::make_shadow_map), Factory(maps::make_vssm)}) {
    const auto begins_at = [&](const char* depth, const char* bias) {
      const Masks found = run(factory, stage, {{"size", "64"}, {"depth", depth}, {"bias", bias}});
      double deepest_lit = 0;
      for (std::uint32_t i = 0; i < kSide; ++i) {
        if (found.visibility[i] == 1) deepest_lit = std::max(deepest_lit, 5 - 2.4 * (i + 0.5) / kSide);
      }
      return deepest_lit;
    };
    const double step = 2.4 / kSide;
    EXPECT_NEAR(begins_at("first", "0"), 2.9, step);
    EXPECT_NEAR(begins_at("midpoint", "0"), 3.9, step);
    EXPECT_NEAR(begins_at("midpoint", "8"), 3.9, step) << "the bias is only where there is no second surface";
    EXPECT_NEAR(begins_at("second", "8"), 4.9, step);
    const double biased = begins_at("first", "8");
    EXPECT_GT(biased, 2.9 + 0.2);
    EXPECT_LT(biased, 3.9 - 0.2);
    EXPECT_EQ(begins_at("dual", "8"), biased);
    EXPECT_NEAR(begins_at("dual", "40"), 3.9, step) << "no farther than the middle";
    EXPECT_GT(begins_at("first", "40"), 4.9) << "the bias alone goes on";
  }
}

// A slab through the floor: the floor is in the shadow of its upper side, but not of its lower side. (soft-shadow-map
// has receivers on the floor only.)
TEST_F(MapsLayers, ASlabThroughTheFloorShadesItAsTheOptionSays) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -2}).casts_shadow = false;
  std::vector<Corners> slab = quad({0, 2, 0}, {1, 0, 0}, {0, 0, -1});
  for (const Corners& lower : quad({0, -0.5, 0}, {1.5, 0, 0}, {0, 0, -1.5})) slab.push_back(lower);
  add_object(scene, "slab", slab).receives_shadow = false;
  scene.lights.push_back(ceiling_light(5, 0.3));
  scene.cameras.push_back(camera({0, 3, 3}, {0, 0, 0}));
  const Stage stage(scene, 8, 8, light_samples(1), grid_samples(8, {0, 0, 0}, {0.5, 0, 0}, {0, 0, 0.5}, {0, 1, 0}));
  const auto lit = [&](const char* depth, const char* bias, const char* form) {
    const Masks found =
        run(maps::make_soft_shadow_map, stage, {{"size", "64"}, {"depth", depth}, {"bias", bias}, {"form", form}});
    const std::set<float> values(found.visibility.begin(), found.visibility.end());
    EXPECT_EQ(values.size(), 1U) << depth << " " << bias << " " << form;
    return *values.begin();
  };
  for (const char* form : {"gather", "scatter"}) {
    EXPECT_EQ(lit("first", "0", form), 0.0F);
    EXPECT_EQ(lit("second", "0", form), 1.0F);
    EXPECT_EQ(lit("midpoint", "0", form), 0.0F);
    // A texel is 2/3 / 62 wide at depth 1: 50 of them at depth 5 are 2.7, more than the distance from 3 to 5.
    EXPECT_EQ(lit("first", "50", form), 1.0F);
    EXPECT_EQ(lit("midpoint", "50", form), 0.0F);
    EXPECT_EQ(lit("dual", "50", form), 0.0F);
  }
}

// convolution does not take the ground for a blocker: a sheet over it has no second surface behind it.
TEST_F(MapsLayers, ASheetOverTheGroundHasNoSecondSurfaceForConvolution) {
  const Stage stage(parallel_square(), 32, 32, light_samples(1));
  const ParallelSquare exact(stage);
  const Masks first = run(maps::make_convolution, stage, {{"size", "64"}}),
              second = run(maps::make_convolution, stage, {{"size", "64"}, {"depth", "second"}});
  std::size_t shaded = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (!exact.on_floor(i)) continue;
    EXPECT_EQ(second.visibility[i], 1);
    shaded += first.visibility[i] < 1 ? 1 : 0;
  }
  EXPECT_GT(shaded, 50U);
}

}  // namespace
}  // namespace penumbra::tests
