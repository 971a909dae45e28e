// SPDX-License-Identifier: Apache-2.0
// Tests V at a receiver's horizon: only what is above the receiver's plane hides light, so that V is the share of the
// light above the horizon less the hidden part of it.

#include "reference/methods.hpp"
#include "tests/analytic/maps/backprojection_scenes.hpp"
#include "tests/analytic/maps/centre_maps.hpp"
#include "tests/analytic/maps/map_variants.hpp"

namespace penumbra::tests {
namespace {

constexpr const char* kHorizonVariants[] = {"backproject",
                                            "backproject:fill=none:search=none",
                                            "backproject:fill=shared:search=mssm",
                                            "backproject-peel:samples=0",
                                            "contour",
                                            "contour:search=none:traversal=flat",
                                            "packet",
                                            "packet:sublights=2",
                                            "bitmask",
                                            "soft-shadow-map:receiverSize=256"};

/// A wall in the plane x = 0, lit from x > 0 by a light at height 5 that reaches 1 to either side of x = `aside`. A
/// board in front of the wall, at height 3.5, reaches from x = `from` to x = `to`. `casts`: the wall casts a shadow.
scenes::Scene wall(double aside, double from, double to, bool casts) {
  scenes::Scene scene;
  add_quad(scene, {0, 1.5, 0}, {0, 1.5, 0}, {0, 0, 1.5}).casts_shadow = casts;
  add_quad(scene, {(from + to) / 2, 3.5, 0}, {(to - from) / 2, 0, 0}, {0, 0, -1.5}).receives_shadow = false;
  scene.lights.push_back(ceiling_light(5, 1));
  std::get<scenes::Rectangle>(scene.lights.back().shape).center.x = aside;
  scene.cameras.push_back(camera({3, 1.5, 0}, {0, 1.5, 0}, 40));
  return scene;
}

class MapsHorizon : public MapsTest {
 protected:
  static Stage stage_of(const scenes::Scene& scene) {
    return {scene, 6, 6, light_samples(256), grid_samples(6, {0, 1.2, 0}, {0, 0.9, 0}, {0, 0, 1.2}, {1, 0, 0})};
  }
};

// About half of the light is below the horizon, and a board that starts at the wall hides all or a part of the rest. A
// texel of the window, which is 1.1 wide to either side, is 2.2 / 128 wide at depth 1, and 1.5 2.9 / 1.4 times as wide
// on the light as seen from the upper end: 0.027 of the light. The board's border may be off by half of that at either
// end, and so may the plane's border, because of the bias.
TEST_F(MapsHorizon, WhatIsHiddenIsTakenFromWhatIsAbove) {
  for (const double aside : {-0.1, 0.4}) {
    for (const double to : {1.5, 0.3}) {
      const Stage stage = stage_of(wall(aside, 0, to, false));
      const Masks exact = tests::run(*reference::make_exact({}), stage);
      for (const char* words : kHorizonVariants) {
        const Masks found = run(*MapVariant(words).with({{"size", "128"}}).make(device()), stage);
        double most = 0;
        for (std::size_t i = 0; i < stage.samples.size(); ++i) {
          most = std::max(most, std::abs(static_cast<double>(found.visibility[i] - exact.visibility[i])));
        }
        fmt::print("{:<40} light at {:+.1f}, board to {:.1f}: off by {:.4f} at most\n", words, aside, to, most);
        EXPECT_LT(most, 0.04) << words << ", light at " << aside << ", board to " << to;
      }
    }
  }
}

// Nothing stands in front of the wall, which casts: below the wall's horizon the light's centre sees the wall's back,
// which hides nothing. (bitmask and soft-shadow-map never counted what is below the horizon; soft-shadow-map is only in
// the test above.)
TEST_F(MapsHorizon, TheWallsOwnBackHidesNothing) {
  for (const double aside : {-0.4, -0.1, 0.1}) {
    scenes::Scene scene = wall(aside, 4, 5, true);
    const Stage stage = stage_of(scene);
    const double above = (1 + aside) / 2;
    for (const char* words : kHorizonVariants) {
      if (std::string(words).starts_with("soft")) continue;
      const Masks found = run(*MapVariant(words).with({{"size", "64"}}).make(device()), stage);
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        // bitmask counts samples, 16 in each direction.
        EXPECT_NEAR(found.visibility[i], above, std::string(words) == "bitmask" ? 0.07 : 1e-4)
            << words << ", " << aside;
      }
    }
  }
}

// Boards behind the wall's plane are below its horizon: the light that they hide is not counted twice.
TEST_F(MapsHorizon, WhatIsBelowThePlaneHidesNothingAboveTheHorizon) {
  for (const double aside : {-0.4, 0.1, 0.4}) {
    const Stage stage = stage_of(wall(aside, -1.5, -0.02, false));
    const double above = (1 + aside) / 2;
    for (const char* words : kHorizonVariants) {
      if (std::string(words).starts_with("soft")) continue;  // its maps know no planes
      const Masks found = run(*MapVariant(words).with({{"size", "64"}}).make(device()), stage);
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        EXPECT_NEAR(found.visibility[i], above, std::string(words) == "bitmask" ? 0.07 : 0.03)
            << words << ", " << aside;
      }
    }
  }
}

}  // namespace
}  // namespace penumbra::tests
