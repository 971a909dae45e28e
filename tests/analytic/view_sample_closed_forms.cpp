// View-sample mapping against shadows that can be written down: exactly the samples that the closed form hides, except
// pairs within the closed form's own rounding of the projected edge, which are counted; and convergence to the area.

#include "tests/agreement/support.hpp"

#include <cmath>
#include <numbers>

namespace penumbra::vsm {
namespace {

using tests::Masks;
using tests::Stage;
using visibility::SamplePattern;
using visibility::ViewSamples;

constexpr double kLightHeight = 4, kLightHalf = 1, kBoardHeight = 1;

/// A floor at height 0, a board at 1 and a square light of half-size 1 at 4, all parallel.
scenes::Scene board_scene(const glm::dvec2& lower, const glm::dvec2& upper) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  const glm::dvec2 middle = 0.5 * (lower + upper), half = 0.5 * (upper - lower);
  tests::add_object(scene, "board", tests::quad({middle.x, kBoardHeight, middle.y}, {half.x, 0, 0}, {0, 0, -half.y}));
  scene.lights.push_back(tests::ceiling_light(kLightHeight, kLightHalf));
  scene.cameras.push_back(tests::camera({0.2, 0.9, 5.1}, {0.1, 0, 0.3}, 60));
  return scene;
}

using ClosedForm = tests::DeviceTest;

struct Comparison {
  std::size_t pairs = 0, hidden = 0, wrong = 0, within_rounding = 0;
};

/// Both sides know the board as stored. The closed form works in double: a crossing point is off by a few of its ulps,
/// and the one tolerance here allows for that.
Comparison compare_pairs(const Stage& stage, const Masks& masks) {
  glm::dvec3 lower(stage.floats.positions.back()), upper = lower;
  for (const std::uint32_t triangle : {2U, 3U}) {
    for (const glm::vec3& corner : stage.floats.corners(triangle)) {
      lower = glm::min(lower, glm::dvec3(corner));
      upper = glm::max(upper, glm::dvec3(corner));
    }
  }
  const double rounding = 16 * 0x1p-53 * std::max(8.0, upper.x - lower.x);
  Comparison result;
  for (std::size_t pixel = 0; pixel < stage.samples.size(); ++pixel) {
    const std::int32_t triangle = stage.samples.triangle[pixel];
    if (triangle == ViewSamples::kBackground || triangle >= 2) continue;  // floor only
    const glm::dvec3 p(stage.samples.p[pixel]);
    for (std::size_t j = 0; j < stage.light.points.size(); ++j) {
      const glm::dvec3 l(stage.light.points[j]);
      const glm::dvec3 q = p + (lower.y - p.y) / (l.y - p.y) * (l - p);
      const double inside = std::min(std::min(q.x - lower.x, upper.x - q.x), std::min(q.z - lower.z, upper.z - q.z));
      ++result.pairs;
      result.hidden += inside > 0 ? 1 : 0;
      if (std::abs(inside) < rounding) {
        ++result.within_rounding;
      } else if (masks.visible(pixel, j) != (inside < 0)) {
        ++result.wrong;
      }
    }
  }
  return result;
}

TEST_F(ClosedForm, ParallelSquareHidesExactlyItsProjection) {
  for (const glm::dvec2& size : {glm::dvec2(0.5, 0.5), glm::dvec2(0.25, 1.5), glm::dvec2(0.7, 0.3)}) {
    for (const SamplePattern pattern : {SamplePattern::rows, SamplePattern::grid, SamplePattern::jittered}) {
      const Stage stage(board_scene(-size, size), 96, 96, {256, 0, 0, pattern, 0});
      const Comparison result =
          compare_pairs(stage, tests::map_view_samples(device(), stage.floats, stage.light, stage.samples));
      EXPECT_GT(result.pairs, 500000U);
      EXPECT_GT(result.hidden, 10000U);
      EXPECT_EQ(result.wrong, 0U) << "of " << result.pairs << ", " << result.within_rounding << " within rounding";
      EXPECT_LE(result.within_rounding, result.pairs / 10000);
    }
  }
}

TEST_F(ClosedForm, HalfPlaneHidesExactlyItsProjection) {
  for (const SamplePattern pattern : {SamplePattern::rows, SamplePattern::sobol}) {
    const Stage stage(board_scene({-64, -64}, {0.25, 64}), 96, 96, {256, 0, 0, pattern, 0});
    const Comparison result =
        compare_pairs(stage, tests::map_view_samples(device(), stage.floats, stage.light, stage.samples));
    EXPECT_GT(result.pairs, 500000U);
    EXPECT_GT(result.hidden, 100000U);
    EXPECT_EQ(result.wrong, 0U) << "of " << result.pairs << ", " << result.within_rounding << " within rounding";
    EXPECT_LE(result.within_rounding, result.pairs / 10000);
  }
}

/// The share of the light [−1, 1]² that the board hides from p on the floor: seen from p the board's corners fall on
/// the light's plane at p + (corner − p) · light height / board height, and stay an axis-aligned rectangle.
double hidden_share(const glm::dvec3& p, const glm::dvec2& half) {
  const double scale = kLightHeight / kBoardHeight;
  const auto overlap = [&](double half_size, double at) {
    const double low = std::max(at + scale * (-half_size - at), -kLightHalf),
                 high = std::min(at + scale * (half_size - at), kLightHalf);
    return std::max(0.0, high - low) / (2 * kLightHalf);
  };
  return overlap(half.x, p.x) * overlap(half.y, p.z);
}

TEST_F(ClosedForm, TheShareConvergesToTheProjectedArea) {
  const glm::dvec2 size(0.19, 0.3);
  double previous = 1;
  for (const std::uint32_t side : {4U, 8U, 16U, 32U, 64U}) {
    const Stage stage(board_scene(-size, size), 64, 64, {side * side, 0, 0, SamplePattern::rows, 0});
    const Masks masks = tests::map_view_samples(device(), stage.floats, stage.light, stage.samples);
    double squares = 0, worst = 0;
    int count = 0;
    for (std::size_t pixel = 0; pixel < stage.samples.size(); ++pixel) {
      const std::int32_t triangle = stage.samples.triangle[pixel];
      if (triangle == ViewSamples::kBackground || triangle >= 2) continue;
      const double hidden = hidden_share(glm::dvec3(stage.samples.p[pixel]) + stage.floats.origin, size);
      if (hidden == 0) continue;
      const double error = masks.visibility[pixel] - (1 - hidden);
      squares += error * error;
      worst = std::max(worst, std::abs(error));
      ++count;
    }
    ASSERT_GT(count, 30);
    // Half a row at each of two edges, and less than a cell along each row.
    EXPECT_LE(worst, 2.0 / side) << side;
    const double rmse = std::sqrt(squares / count);
    EXPECT_LT(rmse, 0.8 * previous) << side;
    previous = rmse;
  }
  EXPECT_LT(previous, 0.003);
}

TEST_F(ClosedForm, AHalfPlaneHidesASegmentOfADisk) {
  // The board's edge, seen from p, is a line at distance d from the disk's centre: a segment of
  // (acos d − d √(1 − d²)) / π of the unit disk remains on its far side.
  scenes::Scene scene = board_scene({-64, -64}, {0.25, 64});
  scene.lights[0].shape = scenes::Disk{{0, kLightHeight, 0}, {0, -1, 0}, 1};
  const Stage stage(scene, 48, 48, {4096, 0, 0, SamplePattern::sobol, 0});
  const Masks masks = tests::map_view_samples(device(), stage.floats, stage.light, stage.samples);
  int partly = 0;
  for (std::size_t pixel = 0; pixel < stage.samples.size(); ++pixel) {
    const std::int32_t triangle = stage.samples.triangle[pixel];
    if (triangle == ViewSamples::kBackground || triangle >= 2) continue;
    const glm::dvec3 p = glm::dvec3(stage.samples.p[pixel]) + stage.floats.origin;
    const double d = std::clamp(p.x + kLightHeight / kBoardHeight * (0.25 - p.x), -1.0, 1.0);
    const double lit = (std::acos(d) - d * std::sqrt(1 - d * d)) / std::numbers::pi;
    EXPECT_NEAR(masks.visibility[pixel], lit, 0.006) << "pixel " << pixel;
    partly += lit > 0.01 && lit < 0.99 ? 1 : 0;
  }
  EXPECT_GT(partly, 50);
}

}  // namespace
}  // namespace penumbra::vsm
