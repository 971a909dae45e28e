// SPDX-License-Identifier: Apache-2.0
// Tests the widths of a map's texels at the places of shadows.
#include "maps/host/texel_widths.hpp"

#include "tests/analytic/maps/parallel_square.hpp"

namespace penumbra::tests {
namespace {

/// The floor, 8 wide, fills the map of a light above its middle except for one texel on every side: texels are 8 /
/// (size − 2) wide on the floor, and 3/5 of that on the occluder, which is 3/5 as far from the light.
TEST(TexelWidths, OfAWindowAreTheFloorsShare) {
  const Stage stage(parallel_square(), 24, 18);
  const ParallelSquare square(stage);
  const std::vector<float> widths =
      maps::texel_widths(stage.floats, stage.samples, stage.light, {{"size", "66"}, {"fit", "receivers"}});
  ASSERT_EQ(widths.size(), stage.samples.size());
  int floors = 0, occluders = 0;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    if (stage.samples.triangle[i] == visibility::ViewSamples::kBackground) {
      EXPECT_TRUE(std::isinf(widths[i]));
      continue;
    }
    const bool floor = square.on_floor(i);
    (floor ? floors : occluders) += 1;
    EXPECT_NEAR(widths[i], (floor ? 1.0 : 0.6) * 8 / 64, 1e-5) << i;
  }
  EXPECT_GT(floors, 50);
  EXPECT_GT(occluders, 5);
}

TEST(TexelWidths, AreNotToldOfOtherFits) {
  const Stage stage(parallel_square(), 8, 6);
  EXPECT_TRUE(maps::texel_widths(stage.floats, stage.samples, stage.light, {{"size", "64"}, {"fit", "view"}}).empty());
  EXPECT_TRUE(maps::texel_widths(stage.floats, stage.samples, stage.light, {}).empty());
}

}  // namespace
}  // namespace penumbra::tests
