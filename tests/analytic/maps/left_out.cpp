// SPDX-License-Identifier: Apache-2.0
// Tests the bounds by which blocks of texels are skipped because none of them can shade a receiver, with inputs that
// come nearest to the bounds.

#include "tests/analytic/maps/backprojection_scenes.hpp"
#include "tests/analytic/maps/backprojection/patch_twin.hpp"

#include <fmt/format.h>

namespace penumbra::tests {
namespace {

using visibility::MethodOptions;

using MapsLeftOut = MapsTest;

// The gaps are far above the rounding of depths, 2⁻²⁴, and far below any share by which a bound could be wrong.
TEST_F(MapsLeftOut, NothingThatIsJustAboveTheFloor) {
  for (const double gap : {1e-2, 1e-3, 1e-4}) {  // share of the light's height
    scenes::Scene scene = bare_floor(0.8);
    add_quad(scene, {0.1, 5 * gap, 0}, {0.9, 0, 0}, {0, 0, -0.7}).receives_shadow = false;
    const Stage stage = on_floor(scene, 24, light_samples(16));
    for (const auto& [factory, name, more] :
         {std::tuple(Factory(maps::make_backproject), "backproject", MethodOptions{{"search", "none"}}),
          std::tuple(Factory(maps::make_backproject_peel), "backproject-peel", MethodOptions{}),
          std::tuple(Factory(maps::make_bitmask), "bitmask", MethodOptions{{"search", "none"}}),
          std::tuple(Factory(maps::make_contour), "contour", MethodOptions{{"traversal", "hierarchy"}})}) {
      MethodOptions options{{"size", "64"}, {"bias", "0"}};
      options.insert(more.begin(), more.end());
      const Masks found = run(factory, stage, options);
      std::size_t lit = 0, dark = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        const glm::dvec3 p = glm::dvec3(stage.samples.p[i]) + stage.floats.origin;
        const double outside = std::max(std::abs(p.x - 0.1) - 0.9, std::abs(p.z) - 0.7);
        if (std::abs(outside) < 0.1) continue;  // the width of a texel and the penumbra together is at most 0.08
        EXPECT_EQ(found.visibility[i], outside > 0 ? 1 : 0) << name << ", gap " << gap << ", pixel " << i;
        ++(outside > 0 ? lit : dark);
      }
      EXPECT_GT(lit, 100U);
      EXPECT_GT(dark, 50U);
    }
  }
}

// A long light whose image is 240 texels wide, and a caster that hides the first few of them. Bounds of the image may
// be wrong by a few hundredths of what the caster hides. The caster's edge is placed at each position in a tile of
// eight texels.
TEST_F(MapsLeftOut, NothingThatIsSeenOnTheLightsBorder) {
  constexpr std::uint32_t kSize = 256;
  constexpr double kTexel = 1.6 * 2 / 240;
  std::vector<double> places;
  for (int i = 0; i < 60; ++i) places.push_back((i + 0.5) / 60 - 0.5);
  std::size_t on_border = 0;
  double most = 0;
  for (int step = 0; step < 8; ++step) {
    scenes::Scene scene = bare_floor(1, 0.5);
    scene.lights.front() = rectangle_light({0, 5, 0}, {2, 0, 0}, {0, 0, 0.05});
    // Seen from the floor at 5 below the light, the light's border appears 1 below the light at x / 5 - 1.6.
    const double edge = -1.6 + step * kTexel;
    add_quad(scene, {edge - 0.25, 4, 0}, {0.25, 0, 0}, {0, 0, -0.5}).receives_shadow = false;
    const Stage stage = along_floor(scene, places, light_samples(1));
    const std::string size = std::to_string(kSize);
    const Masks patches =
        run(maps::make_backproject, stage, {{"size", size}, {"search", "none"}, {"fill", "none"}, {"bias", "0"}});
    const PatchTwin twin(device(), stage, kSize);
    const auto contour = [&](const char* traversal) {
      return run(maps::make_contour, stage, {{"size", size}, {"search", "none"}, {"traversal", traversal}}).visibility;
    };
    const std::vector<float> flat = contour("flat");
    EXPECT_EQ(contour("hierarchy"), flat) << "edge at " << edge;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double expected = twin.visibility(i, Fill::none);
      most = std::max(most, std::abs(static_cast<double>(patches.visibility[i]) - expected));
      on_border += expected < 1 && expected > 1 - 0.02 && flat[i] < 1 ? 1 : 0;
    }
  }
  fmt::print("{} of {} on the light's border; off by at most {:.2g}\n", on_border, 8 * places.size(), most);
  EXPECT_GT(on_border, 100U);
  EXPECT_LT(most, 1e-4);  // as for backproject's sum over all texels: two borders, each about 2⁻²⁰ off
}

}  // namespace
}  // namespace penumbra::tests
