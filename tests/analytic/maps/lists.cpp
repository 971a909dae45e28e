// SPDX-License-Identifier: Apache-2.0
// Tests deep-penumbra's steps, which are joined from the maps of many light samples, against twins and against those
// maps; and properties of all methods with depth lists.

#include "maps/products/lists/penumbra_events.hpp"
#include "tests/analytic/maps/lists.hpp"
#include "tests/unit/passed.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>

namespace penumbra::tests {
namespace {

using visibility::MethodOptions;

class DeepPenumbra : public MapLists {};

// The twin tests places along each texel's ray against each sample's map, in double.
TEST_F(DeepPenumbra, StepsAreTheirTwinAlongEveryRay) {
  constexpr std::uint32_t kSize = 12;
  for (const auto& [wall, two_sided] : {std::pair(false, false), std::pair(true, false), std::pair(true, true)}) {
    for (const std::uint32_t samples : {9U, 36U}) {
      const Stage stage(crowded(wall, two_sided), 4, 4, light_samples(samples));
      const Made made(device(), stage, kSize);
      ASSERT_EQ(made.centre.faces, (wall ? 5U : 1U) + (two_sided ? 5U : 0U));
      const selftest::Check check = selftest::check_penumbra_events(device(), stage, kSize);
      expect_passed(check);
      EXPECT_GT(check.compared, 1000U);
    }
  }
}

TEST_F(DeepPenumbra, CompressedStepsStayWithinTheBoundEverywhere) {
  constexpr std::uint32_t kSize = 24;
  const Stage stage(crowded(false, false), 4, 4, light_samples(64));
  Made made(device(), stage, kSize);
  maps::PenumbraEvents whole(device(), 0);
  whole.make(*made.source);
  const std::vector<std::uint32_t> all = words_of(whole.buffer());
  constexpr std::size_t kTexels = std::size_t{kSize} * kSize;
  std::size_t last = all[kTexels];
  for (const double bound : {0.004, 0.02, 0.1, 0.5}) {
    maps::PenumbraEvents product(device(), bound);
    product.make(*made.source);
    const std::vector<std::uint32_t> words = words_of(product.buffer());
    double worst = 0;
    for (std::size_t texel = 0; texel < kTexels; ++texel) {
      for (std::uint32_t k = all[texel]; k < all[texel + 1]; ++k) {
        // V is constant between two events: read it just behind each.
        const float t = std::nextafter(std::bit_cast<float>(all[kTexels + 1 + 2 * std::size_t{k}]), 1e30F);
        const float exact = selftest::stepped(all, kTexels, texel, t),
                    found = selftest::stepped(words, kTexels, texel, t);
        worst = std::max(worst, static_cast<double>(std::abs(exact - found)));
        EXPECT_TRUE(exact != 1 || found == 1) << "what is lit stays so";
        EXPECT_TRUE(exact != 0 || found == 0) << "what is dark stays so";
      }
    }
    fmt::print("bound {}: {} steps of {}, off by {:.4f}\n", bound, words[kTexels], all[kTexels], worst);
    EXPECT_LE(worst, bound + 1e-6);
    EXPECT_LE(words[kTexels], last);
    last = words[kTexels];
    if (bound >= 0.1) {
      EXPECT_LT(2 * last, all[kTexels]);
      EXPECT_GT(worst, 0.5 * std::min(bound, 0.2)) << "the bound is used";
    }
  }
}

// With one sample, at the light's centre, the ray through a texel stays in that texel of the sample's map.
TEST_F(DeepPenumbra, WithTheCentreAloneItIsTheShadowMap) {
  for (const auto& [wall, two_sided] : {std::pair(false, false), std::pair(true, false), std::pair(true, true)}) {
    const Stage stage(crowded(wall, two_sided), 48, 48, light_samples(1));
    ASSERT_EQ(stage.light.points.front(), stage.light.center);
    for (const auto& [size, bias] :
         {std::pair("8", "0.5"), {"50", "0.5"}, {"128", "0.5"}, {"50", "7"}, {"128", "20"}}) {
      const Masks deep = run(maps::make_deep_penumbra, stage, {{"size", size}, {"bias", bias}}),
                  hard = run(maps::make_shadow_map, stage, {{"size", size}, {"bias", bias}});
      EXPECT_EQ(deep.visibility, hard.visibility) << size << ", bias " << bias;
    }
  }
}

// Half a texel moves an edge over whole rows of samples: the error is proportional to the square root of the texel's
// width.
TEST_F(DeepPenumbra, TendsToAccumulateOnTheSameSamples) {
  const Stage stage(parallel_square(), 48, 48, light_samples(64));
  const Masks truth = run(maps::make_accumulate, stage, {{"size", "1024"}});
  double last = 1;
  for (const char* size : {"32", "96", "288"}) {
    const double error = distance(stage, run(maps::make_deep_penumbra, stage, {{"size", size}, {"bound", "0"}}), truth);
    fmt::print("deep-penumbra, size {}: RMSE {:.5f} to accumulate\n", size, error);
    EXPECT_LT(error, 0.8 * last);
    last = error;
  }
  EXPECT_LT(last, 0.015);
}

TEST_F(MapLists, TilesAndRepetitionChangeNothingAndVIsDefinedEverywhere) {
  scenes::Scene nothing = parallel_square(), crossing = parallel_square(), inside, disk = crowded(false, false);
  nothing.objects[1].casts_shadow = nothing.objects[0].casts_shadow = false;
  add_quad(crossing, {0.5, 5, 0}, {0, 1, 0}, {0, 0, 1});  // through the light
  add_object(inside, "sphere", sphere({0, 0, 0}, 2, 8));  // around light and camera
  inside.lights.push_back(ceiling_light(0, 0.5));
  inside.lights.back().two_sided = true;
  inside.cameras.push_back(camera({0.5, 0.5, 0.5}, {0, -1, 0}, 90));
  disk.lights.front().shape = scenes::Disk{{0, 5, 0}, {0, -1, 0}, 0.5};
  scenes::Scene textured = crowded(false, false);
  textured.lights.front().texture = scenes::Texture{"", 2, 1, {{0, 0, 0}, {1, 1, 1}}};
  for (const Factory& factory : {Factory(maps::make_deep_penumbra), Factory(maps::make_layered_attenuation)}) {
    for (const scenes::Scene& scene : {nothing, crossing, inside, disk, textured}) {
      const Stage stage(scene, 20, 20, light_samples(6));
      for (const char* size : {"8", "50"}) {
        const auto method = factory(device(), {{"size", size}});
        const Masks once = run(*method, stage), tiled = run(*method, stage, 7);
        EXPECT_EQ(once.visibility, tiled.visibility);
        for (const float v : once.visibility) EXPECT_TRUE(v >= 0 && v <= 1) << v;
      }
    }
    // A texture weights samples: V is close to that of accumulate, which uses the same weights.
    const Stage stage(textured, 32, 32, light_samples(36));
    EXPECT_LT(
        distance(stage, run(factory, stage, {{"size", "256"}}), run(maps::make_accumulate, stage, {{"size", "256"}})),
        0.08);
  }
}

}  // namespace
}  // namespace penumbra::tests
