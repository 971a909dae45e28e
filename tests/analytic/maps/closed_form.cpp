// SPDX-License-Identifier: Apache-2.0
#include "tests/analytic/maps/parallel_square.hpp"

#include "visibility/pair_truth.hpp"

namespace penumbra::tests {
namespace {

class MapsClosedForm : public MapsTest {
 protected:
  /// The share of pairs on the floor that accumulate decides differently from the closed form.
  double differing_share(const Stage& stage, std::uint32_t size) {
    const Masks result = run(maps::make_accumulate, stage, {{"size", std::to_string(size)}});
    const ParallelSquare exact(stage);
    const std::uint32_t words = stage.light.words_per_mask();
    std::size_t pairs = 0, differing = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!exact.on_floor(i)) continue;
      for (std::uint32_t j = 0; j < stage.light.sample_count(); ++j) {
        ++pairs;
        differing += ((result.words[i * words + j / 32] >> (j % 32) & 1) != 0) != exact.visible(i, j) ? 1 : 0;
      }
    }
    EXPECT_GT(pairs, 0u);
    return static_cast<double>(differing) / static_cast<double>(pairs);
  }
};

TEST_F(MapsClosedForm, AccumulateConvergesToTheExactCountUnderAParallelSquare) {
  const Stage stage(parallel_square(), 64, 64, light_samples(64));
  // Pairs differ only in a band along the shadow's edges whose width is a texel's: their share is proportional to 1 /
  // size.
  const double coarse = differing_share(stage, 64), middle = differing_share(stage, 256),
               fine = differing_share(stage, 1024);
  EXPECT_LT(coarse, 0.01);
  EXPECT_LT(middle, coarse / 3);
  EXPECT_LT(fine, middle / 3);
}

TEST_F(MapsClosedForm, AccumulateDiffersOnlyWithinATexelOfTheHalfPlanesEdge) {
  const Stage stage(parallel_square(5, 6), 64, 64, light_samples(64));
  const Masks result = run(maps::make_accumulate, stage, {{"size", "512"}});
  const ParallelSquare exact(stage);
  // The floor spans 8 / 5 in tangents from any light point: a texel is 8 / 510 wide on it. The map is right at the
  // texel's centre, half a texel from p, apart from the rasteriser's own snapping: a whole texel covers both.
  const double texel = 8.0 / 510;
  std::size_t differing = 0, near = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (!exact.on_floor(i)) continue;
    for (std::size_t j = 0; j < 64; ++j) {
      const bool visible = (result.words[i * 2 + j / 32] >> (j % 32) & 1) != 0;
      if (visible == exact.visible(i, j)) continue;
      ++differing;
      const glm::dvec3 p = stage.samples.p[i], l = stage.light.points[j];
      // Beyond this x the floor sees l past the edge (x = 1 at height 2 of 5, in world units).
      const double boundary = l.x + (1.0 - stage.floats.origin.x - l.x) * (5.0 / 3.0);
      near += std::abs(p.x - boundary) <= texel ? 1 : 0;
    }
  }
  EXPECT_GT(differing, 0u);
  EXPECT_EQ(near, differing);
}

TEST_F(MapsClosedForm, ShadowMapIsAccumulateWithOneSampleAtTheCentre) {
  const Stage stage(parallel_square(), 64, 64, light_samples(1));
  ASSERT_EQ(stage.light.points.front(), stage.light.center);
  const Masks many = run(maps::make_accumulate, stage), hard = run(maps::make_shadow_map, stage);
  EXPECT_EQ(many.visibility, hard.visibility);
  const ParallelSquare exact(stage);
  // The window holds the floor, ±4 at distance 5, and a texel more on every side. A receiver reads the texel that
  // contains it, whose centre is up to half a texel away along either axis: the map is wrong only that near to the
  // square's outline (half-size 1 at distance 3). Corners are snapped to 1/256 texel.
  const double reach = (0.5 + 1.0 / 256) * 1.6 / 1022;
  std::size_t wrong = 0, beside = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (!exact.on_floor(i) || hard.visibility[i] == static_cast<float>(exact.visibility(i))) continue;
    const glm::dvec3 d = glm::dvec3(stage.samples.p[i]) - glm::dvec3(stage.light.center);
    const glm::dvec2 off(std::abs(std::abs(d.x / d.y) - 1.0 / 3), std::abs(std::abs(d.z / d.y) - 1.0 / 3));
    ++wrong;
    beside += std::min(off.x, off.y) <= reach ? 1 : 0;
  }
  EXPECT_EQ(wrong, beside);
}

TEST_F(MapsClosedForm, TheUndersideOfTheOccluderIsBelowItsHorizonAndNeverLit) {
  const Stage stage(parallel_square(), 64, 64, light_samples(5));
  for (const Factory& factory :
       {Factory(maps::make_accumulate), Factory(maps::make_pcss), Factory(maps::make_shadow_map)}) {
    const Masks result = run(factory, stage);
    std::size_t seen = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      const std::int32_t triangle = stage.samples.triangle[i];
      if (triangle < 0) {
        EXPECT_EQ(result.visibility[i], 1.0f);
      }
      if (triangle < 0 || stage.floats.object[static_cast<std::size_t>(triangle)] != 1) continue;
      ++seen;
      EXPECT_EQ(result.visibility[i], 0.0f);
    }
    EXPECT_GT(seen, 0u);
  }
}

/// Returns the share of pairs at judged pixels that accumulate decides differently from exact arithmetic, the final
/// judge.
double disagreement(const Stage& stage, const Masks& result) {
  const auto classes = visibility::classify_pixels(stage.floats, stage.samples, stage.light);
  const std::uint32_t words = stage.light.words_per_mask();
  std::size_t pairs = 0, differing = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (stage.samples.triangle[i] < 0) continue;
    const bool decided = classes[i] == visibility::PixelClass::judged ||
                         classes[i] == visibility::PixelClass::horizon || classes[i] == visibility::PixelClass::behind;
    if (!decided) continue;
    for (std::uint32_t j = 0; j < stage.light.sample_count(); ++j) {
      const bool visible = (result.words[i * words + j / 32] >> (j % 32) & 1) != 0;
      const auto truth = visibility::decide_pair(stage.floats, stage.samples, i, stage.light, j);
      ++pairs;
      differing += visible != (truth.outcome == visibility::PairOutcome::visible) ? 1 : 0;
    }
  }
  EXPECT_GT(pairs, 0u);
  return static_cast<double>(differing) / static_cast<double>(pairs);
}

TEST_F(MapsClosedForm, ASelfShadowingSphereAgreesWithTheExactPairs) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, 3});
  add_object(scene, "sphere", sphere({0, 1, 0}, 1, 16));
  scene.lights.push_back(ceiling_light(5, 0.5));
  scene.cameras.push_back(camera({4, 3, 5}, {0, 0.8, 0}, 40));
  const Stage stage(scene, 48, 48, light_samples(5));
  EXPECT_LT(disagreement(stage, run(maps::make_accumulate, stage)), 0.005);
}

TEST_F(MapsClosedForm, ARoomWithWallsUpToTheLightsPlaneAndBeyondIsCoveredByHemicubes) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, 3});   // floor
  add_quad(scene, {0, 2, -3}, {3, 0, 0}, {0, 2, 0});  // walls from 0 to 4; the light is at 3
  add_quad(scene, {-3, 2, 0}, {0, 0, 3}, {0, 2, 0});
  add_quad(scene, {3, 2, 0}, {0, 0, 3}, {0, 2, 0});
  add_quad(scene, {-1.5, 2, -1.5}, {0.3, 0.3, 0}, {0, 0, 0.8});
  add_quad(scene, {1.5, 2.6, 0}, {0, 0.2, 0},
           {0, 0, 0.8});  // upright, next to the light: shades the wall near the light's plane
  scene.lights.push_back(ceiling_light(3, 0.4));
  scene.cameras.push_back(camera({0, 2, 7}, {0, 1.7, 0}, 50));
  for (const bool two_sided : {false, true}) {
    scene.lights.front().two_sided = two_sided;
    const Stage stage(scene, 48, 48, light_samples(5));
    const auto method = maps::make_accumulate(device(), {});
    EXPECT_LT(disagreement(stage, run(*method, stage)), 0.005) << "two-sided: " << two_sided;
    EXPECT_EQ(method->counters().at("mapFaces"), method->counters().at("maps") * (two_sided ? 10 : 5));
  }
}

TEST_F(MapsClosedForm, ATwoSidedLightShinesOnBothFloorAndCeiling) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, 3});
  add_quad(scene, {0, 4, 0}, {3, 0, 0}, {0, 0, 3});
  add_quad(scene, {0.2, 3, 0}, {0.5, 0.1, 0}, {0, 0, 0.4});
  add_quad(scene, {-0.2, 1, 0.3}, {0.5, 0.1, 0}, {0, 0, 0.4});
  scene.lights.push_back(ceiling_light(2, 0.4));
  scene.lights.front().two_sided = true;
  scene.cameras.push_back(camera({0, 2, 9}, {0, 2, 0}, 40));
  const Stage stage(scene, 48, 48, light_samples(5));
  EXPECT_LT(disagreement(stage, run(maps::make_accumulate, stage)), 0.005);
}

}  // namespace
}  // namespace penumbra::tests
