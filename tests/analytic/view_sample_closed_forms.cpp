// SPDX-License-Identifier: Apache-2.0
// Tests view-sample mapping against shadows in closed form: it must hide exactly the samples that the closed form
// hides, except pairs within the closed form's own rounding of the projected edge, which are counted; and it must
// converge to the area.

#include "tests/agreement/support.hpp"
#include "tests/analytic/board_over_floor.hpp"

#include <cmath>
#include <numbers>

namespace penumbra::vsm {
namespace {

using tests::Masks;
using tests::Stage;
using visibility::SamplePattern;

class ClosedForm : public tests::DeviceTest {
 protected:
  static Masks masks_of(const Stage& stage) {
    return tests::map_view_samples(device(), stage.floats, stage.light, stage.samples);
  }
  /// No bit may be wrong. In double, the closed form's crossing point is off by a few ulps of coordinates up to
  /// `extent`; the tolerance allows for nothing else.
  static tests::BoardPairs compare(const Stage& stage, double extent) {
    return tests::compare_with_board(stage, masks_of(stage), 16 * 0x1p-53 * extent);
  }
};

TEST_F(ClosedForm, ParallelSquareHidesExactlyItsProjection) {
  for (const glm::dvec2& size : {glm::dvec2(0.5, 0.5), glm::dvec2(0.25, 1.5), glm::dvec2(0.7, 0.3)}) {
    for (const SamplePattern pattern : {SamplePattern::rows, SamplePattern::grid, SamplePattern::jittered}) {
      const Stage stage(tests::board_scene(-size, size), 96, 96, {256, 0, 0, pattern, 0});
      expect_board(compare(stage, 8), 10000, 1e-4);
    }
  }
}

TEST_F(ClosedForm, HalfPlaneHidesExactlyItsProjection) {
  for (const SamplePattern pattern : {SamplePattern::rows, SamplePattern::sobol}) {
    const Stage stage(tests::board_scene({-64, -64}, {0.25, 64}), 96, 96, {256, 0, 0, pattern, 0});
    expect_board(compare(stage, 128), 100000, 1e-4);
  }
}

TEST_F(ClosedForm, TheShareConvergesToTheProjectedArea) {
  tests::expect_board_share_converges(masks_of);
}

TEST_F(ClosedForm, AHalfPlaneHidesASegmentOfADisk) {
  // Seen from p, the board's edge is a line at distance d from the disk's centre: a segment of (acos d − d √(1 − d²)) /
  // π of the unit disk remains visible beyond it.
  scenes::Scene scene = tests::board_scene({-64, -64}, {0.25, 64});
  scene.lights[0].shape = scenes::Disk{{0, tests::kBoardLightHeight, 0}, {0, -1, 0}, 1};
  const Stage stage(scene, 48, 48, {4096, 0, 0, SamplePattern::sobol, 0});
  const Masks masks = masks_of(stage);
  int partly = 0;
  for (std::size_t pixel = 0; pixel < stage.samples.size(); ++pixel) {
    if (!tests::is_on_floor(stage, pixel)) continue;
    const glm::dvec3 p = glm::dvec3(stage.samples.p[pixel]) + stage.floats.origin;
    const double d = std::clamp(p.x + tests::kBoardLightHeight / tests::kBoardHeight * (0.25 - p.x), -1.0, 1.0);
    const double lit = (std::acos(d) - d * std::sqrt(1 - d * d)) / std::numbers::pi;
    EXPECT_NEAR(masks.visibility[pixel], lit, 0.006) << "pixel " << pixel;
    partly += lit > 0.01 && lit < 0.99 ? 1 : 0;
  }
  EXPECT_GT(partly, 50);
}

}  // namespace
}  // namespace penumbra::vsm
