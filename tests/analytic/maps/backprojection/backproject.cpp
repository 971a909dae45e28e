// SPDX-License-Identifier: Apache-2.0
// Tests backprojection against a sum over all texels, against closed forms, and by identities that hold on every scene.

#include "tests/analytic/maps/parallel_square.hpp"
#include "tests/analytic/maps/backprojection/contour_scenes.hpp"
#include "tests/analytic/maps/backprojection/patch_twin.hpp"
#include "tests/unit/mesh/shuffled.hpp"

#include <fmt/format.h>

#include <random>

namespace penumbra::tests {
namespace {

using visibility::MethodOptions;

MethodOptions options_of(std::initializer_list<std::pair<const std::string, std::string>> more,
                         std::uint32_t size = 32) {
  MethodOptions options{{"size", fmt::format("{}", size)}, {"search", "none"}, {"fill", "none"}};
  for (const auto& [key, value] : more) options[key] = value;
  return options;
}

/// Casters, which receive nothing, well above a floor that casts nothing.
scenes::Scene boards_over_floor() {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -2}).casts_shadow = false;
  add_quad(scene, {-0.5, 2, 0.2}, {0.8, 0.3, 0}, {0, 0.1, 0.7}).receives_shadow = false;
  add_quad(scene, {0.7, 1, -0.4}, {0.4, 0, 0.1}, {0, 0.2, 0.5}).receives_shadow = false;
  add_object(scene, "sphere", sphere({0.2, 2.4, 0.5}, 0.4, 6)).receives_shadow = false;
  scene.lights.push_back(ceiling_light(5, 0.8));
  scene.cameras.push_back(camera({0, 5, 0.5}, {0, 0, 0}, 50));
  return scene;
}

/// A small floor, and a caster that shades it although it stands far outside all directions in which the floor is seen.
scenes::Scene blocker_beside() {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {0.2, 0, 0}, {0, 0, -0.2}).casts_shadow = false;
  add_quad(scene, {1.3, 2, 0}, {1, 0, 0}, {0, 0, -3}).receives_shadow = false;
  scene.lights.push_back(ceiling_light(3, 1));
  scene.cameras.push_back(camera({0, 1, 1}, {0, 0, 0}, 20));
  return scene;
}

/// A floor and walls up to the light's plane, which cast nothing, and boards in every direction.
scenes::Scene boards_in_a_room() {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, -3}).casts_shadow = false;
  add_quad(scene, {0, 1.5, -3}, {3, 0, 0}, {0, 1.5, 0}).casts_shadow = false;
  add_quad(scene, {-3, 1.5, 0}, {0, 0, 3}, {0, 1.5, 0}).casts_shadow = false;
  for (const glm::dvec3& centre : {glm::dvec3(-1.4, 1.9, 0), glm::dvec3(0.1, 2, -1.3), glm::dvec3(0.2, 1.7, 0.2)}) {
    add_quad(scene, centre, {0.3, 0.05, 0.3}, {0.2, 0.1, -0.25}).receives_shadow = false;
  }
  scene.lights.push_back(ceiling_light(3, 0.4));
  scene.cameras.push_back(camera({2.8, 1.5, 2.8}, {-1, 1, -1}, 70));
  return scene;
}

/// A tilted floor that casts, too: most of its kernels hold only the floor itself.
scenes::Scene board_over_a_slope() {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 1.2, 0}, {0, 0, -2});
  add_quad(scene, {-0.4, 2, 0.1}, {0.6, 0.2, 0}, {0, 0.1, 0.6}).receives_shadow = false;
  scene.lights.push_back(ceiling_light(5, 0.8));
  scene.cameras.push_back(camera({-1, 5, 0.5}, {0, 0, 0}, 50));
  return scene;
}

class MapsBackproject : public MapsTest {
 protected:
  /// The largest and the mean difference between backproject and its twin over receivers.
  static std::pair<double, double> off(const Stage& stage, const PatchTwin& twin, std::uint32_t size, Fill fill,
                                       const MethodOptions& more = {}) {
    MethodOptions options = options_of({}, size);
    options["fill"] = fill == Fill::none ? "none" : fill == Fill::edges ? "edges" : "diagonal";
    for (const auto& [key, value] : more) options[key] = value;
    const Masks found = run(maps::make_backproject, stage, options);
    double most = 0, sum = 0;
    std::size_t count = 0, partly = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!visibility::is_receiver(stage.floats, stage.light, stage.samples, i) || !twin.is_below_all_casters(i))
        continue;
      const double expected = twin.visibility(i, fill), off = std::abs(found.visibility[i] - expected);
      most = std::max(most, off);
      sum += off;
      ++count;
      partly += expected > 0 && expected < 1 ? 1 : 0;
    }
    EXPECT_GT(partly, 30U);
    return {most, sum / static_cast<double>(count)};
  }
};

// Borders are floats around 1 in light coordinates, each off by about 2⁻²⁰ where f magnifies by ten. Only outer borders
// of what hides the light count, about a hundred of them here: 1e-4. A kernel that misses a texel, or a constant that
// is 2 % off, moves V by far more.
TEST_F(MapsBackproject, IsTheSumOfAllTexelsOneByOne) {
  for (const auto& [scene, name, faces] :
       {std::tuple(boards_over_floor(), "boards", 1U), std::tuple(blocker_beside(), "beside", 1U)}) {
    const Stage stage(scene, 20, 20, light_samples(1));
    const PatchTwin twin(device(), stage, 32);
    ASSERT_EQ(twin.faces(), faces);
    for (const Fill fill : {Fill::none, Fill::edges, Fill::diagonal}) {
      const auto [most, mean] = off(stage, twin, 32, fill);
      fmt::print("{}: off by at most {:.2g}, {:.2g} in the mean\n", name, most, mean);
      EXPECT_LT(most, 1e-4) << name;
    }
  }
}

// On sideways faces the sides of a texel are placed where they are seen from the middle of its row. Over a row this is
// exact on average, so that only corners of the outline are wrong, each by a fraction of a texel's square.
TEST_F(MapsBackproject, AHemicubesFacesTooToASquareTexel) {
  const Stage stage(boards_in_a_room(), 24, 24, light_samples(1));
  const PatchTwin twin(device(), stage, 48);
  ASSERT_EQ(twin.faces(), 5U);
  const auto [most, mean] = off(stage, twin, 48, Fill::none);
  fmt::print("hemicube: off by at most {:.2g}, {:.2g} in the mean\n", most, mean);
  // Measured: 0.0011 and 5e-5.
  EXPECT_LT(most, 0.003);
  EXPECT_LT(mean, 0.0001);
}

// A coarse level is a map of its blocks' nearest depths (Guennebaud et al. 2007), also for blocks that reach beyond the
// map's end.
TEST_F(MapsBackproject, ALevelIsTheSumOfItsBlocks) {
  const Stage stage(boards_over_floor(), 20, 20, light_samples(1));
  for (const auto& [size, level] : {std::pair(64U, 1U), std::pair(75U, 2U)}) {
    const PatchTwin twin(device(), stage, size, level);
    for (const Fill fill : {Fill::none, Fill::edges, Fill::diagonal}) {
      const auto [most, mean] = off(stage, twin, size, fill, {{"level", fmt::format("{}", level)}});
      fmt::print("level {}: off by at most {:.2g}, {:.2g} in the mean\n", level, most, mean);
      EXPECT_LT(most, 1e-4) << "level " << level;
    }
  }
}

// Blocks are nearer than the texels that a search reads, most of all on curved surfaces: a search at a coarse level
// must leave out no block, and must not take what texels hide for what blocks hide.
TEST_F(MapsBackproject, NoSearchChangesALevel) {
  const Stage stage(ball_over_floor(1), 20, 20, light_samples(8));
  std::size_t partly = 0;
  const auto expect_same = [&](const Factory& factory, const MethodOptions& options, const std::string& what) {
    MethodOptions none = options;
    none["search"] = "none";
    const std::vector<float> found = run(factory, stage, options).visibility;
    EXPECT_EQ(found, run(factory, stage, none).visibility) << what;
    partly += static_cast<std::size_t>(std::ranges::count_if(found, [](float v) { return v > 0 && v < 1; }));
  };
  for (const char* level : {"1", "2", "3", "4"}) {
    for (const char* fill : {"none", "edges"})
      expect_same(maps::make_backproject, {{"size", "96"}, {"level", level}, {"fill", fill}, {"search", "hsm"}},
                  fmt::format("backproject, level {}, fill {}", level, fill));
    for (const char* occluder : {"patch", "quad"})
      expect_same(maps::make_bitmask, {{"size", "96"}, {"level", level}, {"occluder", occluder}, {"search", "hsm"}},
                  fmt::format("bitmask, level {}, {}", level, occluder));
  }
  EXPECT_GT(partly, 400U);
}

// With a budget, each pixel looks at one level, or at two levels blended with weights (Guennebaud et al. 2007).
TEST_F(MapsBackproject, ABudgetChoosesLevelsAndBlendsThem) {
  const Stage stage(boards_over_floor(), 24, 24, light_samples(1));
  for (const char* form : {"patch", "sphere"}) {
    const auto with = [&](MethodOptions options) {
      options.emplace("size", "96");
      options.emplace("form", form);
      return run(maps::make_backproject, stage, options).visibility;
    };
    std::vector<std::vector<float>> levels;
    for (const char* level : {"0", "1", "2", "3", "4"}) levels.push_back(with({{"level", level}}));
    EXPECT_EQ(with({{"budget", "100000"}}), levels[0]);
    EXPECT_EQ(with({{"budget", "100000"}, {"level", "2"}}), levels[2]);
    std::size_t between = 0, coarse = 0;
    for (const char* budget : {"60", "150"}) {
      const std::vector<float> stepped = with({{"budget", budget}, {"blend", "off"}}),
                               blended = with({{"budget", budget}});
      for (std::size_t i = 0; i < stepped.size(); ++i) {
        bool one = false, two = false;
        for (std::size_t l = 0; l < levels.size(); ++l) {
          one = one || stepped[i] == levels[l][i];
          coarse += l > 0 && stepped[i] == levels[l][i] && stepped[i] != levels[0][i] ? 1 : 0;
          if (l == 0) continue;
          // Each part is rounded once per texel, to 2^-30 of the light and to a float's 2^-24 of what it hides.
          const float low = std::min(levels[l - 1][i], levels[l][i]), high = std::max(levels[l - 1][i], levels[l][i]);
          two = two || (blended[i] >= low - 1e-6F && blended[i] <= high + 1e-6F);
          between += blended[i] > low + 1e-3F && blended[i] < high - 1e-3F ? 1 : 0;
        }
        EXPECT_TRUE(one) << form << " " << budget << ", pixel " << i;
        EXPECT_TRUE(two) << form << " " << budget << ", pixel " << i;
      }
    }
    EXPECT_GT(coarse, 50U) << form;
    EXPECT_GT(between, 50U) << form;
  }
}

TEST_F(MapsBackproject, BothSidesOfATwoSidedLight) {
  scenes::Scene scene = boards_over_floor();
  add_quad(scene, {0, 9, 0}, {2, 0, 0}, {0, 0, 2}).casts_shadow = false;
  add_quad(scene, {0.3, 7, 0}, {0.5, 0.2, 0}, {0, 0, 0.6}).receives_shadow = false;
  scene.lights.front().two_sided = true;
  scene.cameras.front() = camera({0, 4, 9}, {0, 4.5, 0}, 75);
  const Stage stage(scene, 32, 32, light_samples(1));
  const PatchTwin twin(device(), stage, 32);
  ASSERT_EQ(twin.faces(), 2U);
  EXPECT_LT(off(stage, twin, 32, Fill::edges).first, 1e-4);
}

// A search finds narrower kernels but changes no result, except that where the whole kernel hides, all of the light is
// hidden.
TEST_F(MapsBackproject, SearchesChangeNothingButPatchesThatCoverTheKernel) {
  for (const auto& [scene, fill] : {std::pair(boards_over_floor(), "none"), std::pair(boards_in_a_room(), "edges"),
                                    std::pair(parallel_square(), "none"), std::pair(board_over_a_slope(), "edges")}) {
    const Stage stage(scene, 24, 24, light_samples(1));
    const Masks plain = run(maps::make_backproject, stage, options_of({{"fill", fill}}, 48));
    for (const char* search : {"hsm", "mssm", "ysm"}) {
      const Masks found = run(maps::make_backproject, stage, options_of({{"fill", fill}, {"search", search}}, 48));
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        // Without the search, a pixel that all texels hide is nearly dark, except for light through gaps between
        // texels.
        EXPECT_TRUE(found.visibility[i] == plain.visibility[i] ||
                    (found.visibility[i] == 0 && plain.visibility[i] < 0.5F))
            << search << ", pixel " << i << ": " << found.visibility[i] << " for " << plain.visibility[i];
      }
    }
  }
}

// Parallel rectangles are exact except for half a texel at each of an axis's two edges, f / w_l texels on the light.
TEST_F(MapsBackproject, IsWithinATexelOfTheAreaUnderAParallelSquare) {
  for (const std::uint32_t size : {16U, 31U, 33U, 128U}) {
    const Stage stage(parallel_square(), 32, 32, light_samples(1));
    const ParallelSquare exact(stage);
    // The light is at 5 and 2 wide, the square at depth 3: f = 3 · 5 / (5 − 3). The window is ±(0.8 + one texel).
    const double texel = 1.6 / (size - 2), bound = 2 * texel * 7.5 / 2;
    for (const char* search : {"none", "hsm"}) {
      const Masks found = run(maps::make_backproject, stage, options_of({{"search", search}}, size));
      double most = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        if (exact.on_floor(i)) most = std::max(most, std::abs(found.visibility[i] - exact.area(i)));
      }
      fmt::print("size {}: off by at most {:.4f}, bound {:.4f}\n", size, most, bound);
      EXPECT_LT(most, bound + 1e-5);
      EXPECT_GT(most, bound / 100) << "the bound says nothing";
    }
  }
}

// Two cases are exact to the bit: no caster in the kernel, and a plate that covers it.
TEST_F(MapsBackproject, UmbraAndFullLightAreExact) {
  scenes::Scene scene = parallel_square();
  scene.objects[0].casts_shadow = false;
  const Stage stage(scene, 32, 32, light_samples(1));
  const ParallelSquare exact(stage);
  for (const char* fill : {"none", "edges", "diagonal"}) {
    for (const char* search : {"none", "mssm"}) {
      const Masks found = run(maps::make_backproject, stage, options_of({{"fill", fill}, {"search", search}}, 64));
      std::size_t lit = 0, dark = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        if (!exact.on_floor(i)) continue;
        // The umbra is |x| < 1, full light is beyond 2.33; a texel is 0.13 wide on the floor.
        const glm::dvec3 p = glm::dvec3(stage.samples.p[i]) + stage.floats.origin;
        if (std::max(std::abs(p.x), std::abs(p.z)) < 1 - 0.2) {
          EXPECT_EQ(found.visibility[i], 0);
          ++dark;
        } else if (std::max(std::abs(p.x), std::abs(p.z)) > 7.0 / 3 + 0.2) {
          EXPECT_EQ(found.visibility[i], 1);
          ++lit;
        }
      }
      EXPECT_GT(lit, 20U);
      EXPECT_GT(dark, 5U);
    }
  }
}

// The bias decides which texels hide light, not where: casters well above the floor hide the same with any of these
// values.
TEST_F(MapsBackproject, TheBiasMovesNothing) {
  const Stage stage(boards_over_floor(), 20, 20, light_samples(1));
  const Masks none = run(maps::make_backproject, stage, options_of({{"bias", "0"}}));
  for (const char* bias : {"0.5", "2", "4"}) {
    EXPECT_EQ(run(maps::make_backproject, stage, options_of({{"bias", bias}})).visibility, none.visibility);
  }
}

TEST_F(MapsBackproject, ALightWithoutExtentGivesTheShadowMap) {
  scenes::Scene scene = boards_over_floor();
  scene.lights.front() = ceiling_light(5, 1e-6);
  const Stage stage(scene, 40, 40, light_samples(1));
  const Masks hard = run(maps::make_shadow_map, stage, {{"size", "64"}});
  for (const char* fill : {"none", "edges"}) {
    const Masks found = run(maps::make_backproject, stage, options_of({{"fill", fill}}, 64));
    std::size_t different = 0, shaded = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      different += found.visibility[i] != hard.visibility[i] ? 1 : 0;
      shaded += hard.visibility[i] == 0 ? 1 : 0;
    }
    // The two windows could differ only by casters beside the floor's directions, and there are none. A light of 1e-6 ·
    // f = 1e-5 meets the border of a texel, of which there are 64 across the picture, at about 64 · 40 · 1e-5 pixels.
    EXPECT_EQ(different, 0U) << fill;
    EXPECT_GT(shaded, 100U);
  }
}

TEST_F(MapsBackproject, TrianglesMayComeInAnyOrderAndWinding) {
  scenes::Scene scene = boards_over_floor();
  const Stage stage(scene, 20, 20, light_samples(1));
  const Masks one = run(maps::make_backproject, stage, options_of({{"fill", "edges"}, {"search", "hsm"}}));
  std::mt19937 random(6);
  shuffle_order(scene.soup, random);
  shuffle_corners(scene.soup, random);
  const Stage shuffled(scene, 20, 20, light_samples(1));
  EXPECT_EQ(run(maps::make_backproject, shuffled, options_of({{"fill", "edges"}, {"search", "hsm"}})).visibility,
            one.visibility);
}

}  // namespace
}  // namespace penumbra::tests
