// SPDX-License-Identifier: Apache-2.0
// The error curves of Atty et al. 2006: soft-shadow-map's error and work over passes, resolution, and the light's size.

#include "tests/analytic/maps/backprojection/soft_shadow_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra::tests {
namespace {

/// Options with a quarter of the default number of receiver texels: the tests' findings are the same, in a quarter of
/// the time.
MethodOptions few_receivers(MethodOptions options = {}) {
  options["receiverSize"] = "128";
  return options;
}

// For solids the second pass adds what the light's centre does not see of them, at every pixel, and costs about as much
// as the first.
TEST_F(SoftShadowMap, TwoPassesAreDarkerEverywhereAndNearerToTheTruthForSolids) {
  double small_light = 0;
  for (const double half : {0.1, 0.25, 0.5, 1.0}) {
    const Stage stage(ball(half), 64, 64, light_samples(1));
    const Masks truth = exact(stage);
    const Run one = soft(stage, few_receivers()), two = soft(stage, few_receivers({{"passes", "2"}}));
    for (std::size_t i = 0; i < stage.samples.size(); ++i)
      EXPECT_LE(two.picture.visibility[i], one.picture.visibility[i]);
    const Measure first = measure(stage, one.picture, truth), second = measure(stage, two.picture, truth);
    const double work =
        static_cast<double>(two.fragments + two.patches) / static_cast<double>(one.fragments + one.patches);
    fmt::print("light half {}: error {:.4f} in one pass, {:.4f} in two; work {:.2f}; umbra {} and {} of {}\n", half,
               first.error, second.error, work, first.umbra, second.umbra, first.true_umbra);
    EXPECT_LT(second.error, first.error);
    // There are twice as many patches, but those of the far side have smaller penumbrae.
    EXPECT_EQ(two.patches, 2 * one.patches);
    EXPECT_GT(work, 1.0);
    EXPECT_LT(work, 2.0);
    if (half == 0.1) small_light = first.error;
    if (half == 0.5) {
      EXPECT_GT(first.error, 2 * small_light);
    }
    if (half == 0.25) {  // umbrae are not grossly over- or underestimated
      EXPECT_GT(second.umbra, 0.8 * second.true_umbra);
      EXPECT_LT(second.umbra, 1.25 * second.true_umbra);
    }
  }
}

// In a thin solid both sides are at about the same depth: two passes do twice the work.
TEST_F(SoftShadowMap, TwoPassesOverAThinSolidCostTwice) {
  scenes::Scene scene = floor_and_light(0.5);
  add_quad(scene, {0, 2, 0}, {1, 0, 0}, {0, 0, 1});
  add_quad(scene, {0, 1.95, 0}, {1, 0, 0}, {0, 0, 1});
  const Stage stage(scene, 16, 16, light_samples(1));
  const Run one = soft(stage), two = soft(stage, {{"passes", "2"}});
  const double work = static_cast<double>(two.fragments) / static_cast<double>(one.fragments);
  fmt::print("thin solid: work of two passes {:.3f}\n", work);
  EXPECT_GT(work, 1.85);
  EXPECT_LT(work, 2.0);
}

// Beyond some resolution the remaining error comes from the silhouette; it grows as the solid approaches the light.
TEST_F(SoftShadowMap, TheErrorStopsFallingWithResolutionAndGrowsTowardTheLight) {
  const Stage stage(ball(0.5), 64, 64, light_samples(1));
  const Masks truth = exact(stage);
  const auto error = [&](const char* size) {
    return measure(stage, soft(stage, few_receivers({{"size", size}})).picture, truth).error;
  };
  const double coarse = error("100"), fine = error("200");
  fmt::print("size 100: error {:.4f}, 200: {:.4f}\n", coarse, fine);
  EXPECT_GT(fine, 0.8 * coarse);
  double last = 0;
  for (const double height : {1.2, 2.0, 2.8, 3.4}) {
    const Stage near(ball(0.5, height), 64, 64, light_samples(1));
    const double found = measure(near, soft(near, few_receivers({{"size", "64"}})).picture, exact(near)).error;
    fmt::print("sphere at {}: error {:.4f}\n", height, found);
    EXPECT_GT(found, 0.9 * last);
    last = found;
  }
}

// The paper's figure 23: small lights need large maps; for large lights small maps are good enough.
TEST_F(SoftShadowMap, LargeLightsDoWithSmallMaps) {
  double last = 1e9;
  for (const double half : {0.05, 0.25, 1.0}) {
    const Stage stage(ball(half), 64, 64, light_samples(1));
    const Masks truth = exact(stage);
    const auto error = [&](const char* size) {
      return measure(stage, soft(stage, few_receivers({{"size", size}})).picture, truth).error;
    };
    const double coarse = error("24"), fine = error("192"), gain = coarse / fine;
    fmt::print("light half {}: error {:.4f} of 24^2 texels, {:.4f} of 192^2, {:.2f} times\n", half, coarse, fine, gain);
    EXPECT_LT(gain, last);
    last = gain;
  }
}

// Errors of aligned edges add up, those of other edges cancel (5.1.1).
TEST_F(SoftShadowMap, ATurnedSquareIsNearerToTheTruthThanTheWorstAlignedOne) {
  const auto error = [&](double degrees, double shift) {
    const double angle = degrees * std::numbers::pi / 180;
    scenes::Scene scene = floor_and_light(0.5);
    add_quad(scene, {shift, 2, shift}, {std::cos(angle), 0, std::sin(angle)}, {-std::sin(angle), 0, std::cos(angle)});
    add_quad(scene, {-2.2, 2, -2.2}, {0.1, 0, 0}, {0, 0, 0.1});  // keeps the window the same
    add_quad(scene, {2.2, 2, 2.2}, {0.1, 0, 0}, {0, 0, 0.1});
    const Stage stage(scene, 64, 64, light_samples(1));
    return measure(stage, soft(stage, {{"size", "42"}, {"receiverSize", "512"}}).picture, exact(stage)).error;
  };
  double worst = 0;
  for (int i = 0; i < 4; ++i) worst = std::max(worst, error(0, 4.6 / 40 * i / 4));
  const double turned = error(30, 0);
  fmt::print("error of a square: turned {:.4f}, aligned at worst {:.4f}\n", turned, worst);
  EXPECT_LT(turned, worst);
}

}  // namespace
}  // namespace penumbra::tests
