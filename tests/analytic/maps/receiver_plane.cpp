// receiverPlane: texels are compared with the receiver's plane, or with its own depth, as papers have it. (What the
// bias forgives in either: Bias.*; that hierarchies know of it: MapsIdentities.*.)

#include "tests/analytic/maps/backprojection_scenes.hpp"
#include "tests/analytic/maps/centre_maps.hpp"
#include "tests/analytic/maps/ways.hpp"

#include <numbers>

namespace penumbra::tests {
namespace {

class ReceiverPlane : public MapsTest {
 protected:
  static constexpr const char* kWays[] = {"shadow-map",
                                          "pcf",
                                          "pcss",
                                          "backproject",
                                          "backproject:form=sphere",
                                          "backproject-peel:depth=first",
                                          "bitmask",
                                          "bitmask:occluder=patch",
                                          "contour",
                                          "packet"};
  static Masks picture(const Stage& stage, const char* words, visibility::MethodOptions more) {
    more["size"] = "64";
    const Way way = Way(words).with(more);
    return run(*way.make(device()), stage);
  }
};

// What receives parallel to the light has one depth wherever its plane is asked.
TEST_F(ReceiverPlane, MakesNoDifferenceToWhatIsParallelToTheLight) {
  const Stage stage = on_floor(square_above_plate(), 10, light_samples(16));
  for (const char* words : kWays) {
    EXPECT_EQ(picture(stage, words, {{"receiverPlane", "off"}}).visibility, picture(stage, words, {}).visibility)
        << words;
  }
}

// A plane that is tilted to the light and nothing else (Eisemann et al. 2009, figure 4.3): in its own depth it shades
// itself, by its plane not.
TEST_F(ReceiverPlane, OffATiltedPlaneShadesItself) {
  for (const double tilt : {30.0, 60.0}) {
    const double angle = tilt * std::numbers::pi / 180;
    const glm::dvec3 along(std::cos(angle), std::sin(angle), 0), up(-std::sin(angle), std::cos(angle), 0);
    scenes::Scene scene;
    add_quad(scene, {0, 0, 0}, along, {0, 0, -1});
    scene.lights.push_back(ceiling_light(5, 0.25));
    scene.cameras.push_back(camera({0, 3, 3}, {0, 0, 0}));
    const Stage stage(scene, 16, 16, light_samples(16), grid_samples(16, {0, 0, 0}, 0.6 * along, {0, 0, 0.6}, up));
    for (const char* words : kWays) {
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

}  // namespace
}  // namespace penumbra::tests
