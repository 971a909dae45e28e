// SPDX-License-Identifier: Apache-2.0
// Tests receiverPlane: texels are compared with the receiver's plane, or with its own depth, as in papers. (Bias.*
// tests how much the bias forgives in either case, MapsIdentities.* that hierarchies take it into account.)

#include "tests/analytic/maps/backprojection_scenes.hpp"
#include "tests/analytic/maps/centre_maps.hpp"
#include "tests/analytic/maps/map_variants.hpp"

#include <numbers>

namespace penumbra::tests {
namespace {

class ReceiverPlane : public MapsTest {
 protected:
  static constexpr const char* kVariants[] = {"shadow-map",
                                              "pcf",
                                              "pcss",
                                              "backproject",
                                              "backproject:form=sphere",
                                              "backproject-peel:depth=first",
                                              "bitmask",
                                              "bitmask:occluder=patch",
                                              "layer-rays",
                                              "penumbra-map",
                                              "smoothies",
                                              "brabec-seidel:ids=off",
                                              "parker",
                                              "arvo",
                                              "contour",
                                              "packet"};
  static Masks picture(const Stage& stage, const char* words, visibility::MethodOptions more) {
    more.emplace("size", "64");
    const MapVariant variant = MapVariant(words).with(more);
    return run(*variant.make(device()), stage);
  }
};

// A receiver parallel to the light has the same depth wherever its plane is evaluated.
TEST_F(ReceiverPlane, MakesNoDifferenceToWhatIsParallelToTheLight) {
  const Stage stage = on_floor(square_above_plate(), 10, light_samples(16));
  for (const char* words : kVariants) {
    EXPECT_EQ(picture(stage, words, {{"receiverPlane", "off"}}).visibility, picture(stage, words, {}).visibility)
        << words;
  }
}

// A plane that is tilted to the light and nothing else (Eisemann et al. 2009, figure 4.3): compared by its own depth it
// shades itself, compared by its plane it does not.
TEST_F(ReceiverPlane, OffATiltedPlaneShadesItself) {
  for (const double tilt : {30.0, 60.0}) {
    const double angle = tilt * std::numbers::pi / 180;
    const glm::dvec3 along(std::cos(angle), std::sin(angle), 0), up(-std::sin(angle), std::cos(angle), 0);
    scenes::Scene scene;
    add_quad(scene, {0, 0, 0}, along, {0, 0, -1});
    scene.lights.push_back(ceiling_light(5, 0.25));
    scene.cameras.push_back(camera({0, 3, 3}, {0, 0, 0}));
    const Stage stage(scene, 16, 16, light_samples(16), grid_samples(16, {0, 0, 0}, 0.6 * along, {0, 0, 0.6}, up));
    for (const char* words : kVariants) {
      const Masks on = picture(stage, words, {{"bias", "0.02"}}),
                  off = picture(stage, words, {{"bias", "0"}, {"receiverPlane", "off"}});
      double sum = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        EXPECT_EQ(on.visibility[i], 1.0F) << words << ", " << tilt << " degrees, pixel " << i;
        sum += static_cast<double>(off.visibility[i]) / static_cast<double>(stage.samples.size());
      }
      fmt::print("{}, {} degrees, own depth: V {:.3f} in the mean\n", words, tilt, sum);
      // Quads between points of the receiver's own plane hide nothing above its horizon.
      if (words == std::string("bitmask")) {
        EXPECT_EQ(sum, 1);
      } else {
        EXPECT_LT(sum, 0.75) << words;
      }
    }
  }
}

// A plane's horizon cuts the light: the share above it is (4 + 5 / tan 60) / 8 = 0.86. One board in front of the plane
// hides half of the light. Another, beyond the receiver's plane, hides 3/32 of it, below the horizon: that counts only
// with the own depth, which knows no horizon (V is at most the share above).
TEST_F(ReceiverPlane, OffWhatIsBelowTheHorizonHidesLight) {
  constexpr double kTilt = std::numbers::pi / 3;
  const glm::dvec3 along(std::cos(kTilt), std::sin(kTilt), 0), up(-std::sin(kTilt), std::cos(kTilt), 0);
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, 0.01 * along, {0, 0, -0.01});
  add_quad(scene, {-1, 2, 0}, {1, 0, 0}, {0, 0, -2});       // appears on the light from -5 to 0
  add_quad(scene, {1.65, 2, 0}, {0.35, 0, 0}, {0, 0, -2});  // appears from 3.25 to 5
  scene.lights.push_back(ceiling_light(5, 4));
  scene.cameras.push_back(camera({-3, 0, 3}, {0, 0, 0}));
  const Stage stage(scene, 2, 2, light_samples(16), grid_samples(2, {0, 0, 0}, 0.001 * along, {0, 0, 0.001}, up));
  for (const char* words : {"contour", "contour:search=none:traversal=flat", "packet", "backproject"}) {
    const Masks on = picture(stage, words, {{"size", "256"}}),
                off = picture(stage, words, {{"size", "256"}, {"receiverPlane", "off"}});
    // Texels are 0.007 wide on the boards and 0.017 on the light, 0.2 % of it: each of the three edges may be off by
    // one.
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      EXPECT_NEAR(on.visibility[i], (4 + 5 / std::tan(kTilt)) / 8 - 0.5, 0.007) << words;
      EXPECT_NEAR(off.visibility[i], 0.5 - 3.0 / 32, 0.007) << words;
    }
  }
}

// Hourcade and Nicolas 1985: a texel that names the nearest surface needs no bias, so that no bias moves a shadow. The
// price is that where triangles of several planes share a texel, all but one of them are dark.
TEST_F(ReceiverPlane, IdsNeedNoBiasAndLoseWhatSharesATexel) {
  for (const double tilt : {0.0, 30.0, 70.0}) {
    const double angle = tilt * std::numbers::pi / 180;
    const glm::dvec3 along(std::cos(angle), std::sin(angle), 0), up(-std::sin(angle), std::cos(angle), 0);
    scenes::Scene scene;
    add_quad(scene, {0, 0, 0}, 2.0 * along, {0, 0, -2});
    // The quad is as near above the plane as floats allow: a bias large enough for the plane's slope would forgive this
    // quad, too.
    add_quad(scene, 1e-4 * up, 0.5 * along, {0, 0, -0.5}).receives_shadow = false;
    scene.lights.push_back(ceiling_light(5, 0.25));
    scene.cameras.push_back(camera({0, 3, 3}, {0, 0, 0}));
    const Stage stage(scene, 24, 24, light_samples(1), grid_samples(24, {0, 0, 0}, 1.5 * along, {0, 0, 1.5}, up));
    const Masks ids = picture(stage, "shadow-map", {{"test", "id"}, {"size", "256"}});
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      const auto step = [&](std::size_t k) { return std::abs((2.0 * static_cast<double>(k) + 1) / 24 - 1) * 1.5; };
      const double s = step(i % 24), t = step(i / 24);
      if (std::abs(s - 0.5) < 0.05 || std::abs(t - 0.5) < 0.05) continue;  // within texels of the board's edge
      EXPECT_EQ(ids.visibility[i], s < 0.5 && t < 0.5 ? 0.0F : 1.0F) << tilt << " degrees, pixel " << i;
    }
    // Seen from below, the plane's own triangles are between receiver and light, and are the nearest.
    const Stage below(scene, 8, 8, light_samples(1), grid_samples(8, {0, 0, 0}, 1.5 * along, {0, 0, 1.5}, -up));
    for (const float v : picture(below, "shadow-map", {{"test", "id"}}).visibility) EXPECT_EQ(v, 0.0F) << tilt;
  }
  // A ball of planes as small as texels: by depth its upper side is lit, by ids only those planes that a texel happens
  // to name.
  scenes::Scene scene;
  add_quad(scene, {0, -2, 0}, {2, 0, 0}, {0, 0, -2});
  add_object(scene, "ball", sphere({0, 0, 0}, 1, 40));
  scene.lights.push_back(ceiling_light(5, 0.25));
  scene.cameras.push_back(camera({0, 3, 0.1}, {0, 0, 0}, 30));
  const Stage stage(scene, 24, 24, light_samples(1));
  const auto lit = [&](const char* test) {
    const Masks found = picture(stage, "shadow-map", {{"test", test}, {"size", "32"}});
    std::size_t count = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      const std::int32_t triangle = stage.samples.triangle[i];
      if (triangle >= 2 && stage.samples.n[i].y > 0.5F) count += found.visibility[i] == 1 ? 1 : 0;
    }
    return count;
  };
  const std::size_t by_depth = lit("depth"), by_id = lit("id");
  fmt::print("a ball of small planes: {} pixels lit by depth, {} by ids\n", by_depth, by_id);
  EXPECT_GT(by_depth, 100U);
  EXPECT_LT(by_id, by_depth / 2);
  EXPECT_GT(by_id, 0U);
}

}  // namespace
}  // namespace penumbra::tests
