// SPDX-License-Identifier: Apache-2.0
#pragma once

// A floor, a board and a square light, all parallel: closed forms give which light samples a view sample on the floor
// sees, and which share of the light.

#include "tests/unit/ray_traced_masks.hpp"
#include "tests/unit/visibility/scenes.hpp"

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace penumbra::tests {

constexpr double kBoardHeight = 1, kBoardLightHeight = 4, kBoardLightHalf = 1;

/// The floor is at height 0, the board from `lower` to `upper` (x and z) at 1, the light of half-size 1 at 4.
inline scenes::Scene board_scene(const glm::dvec2& lower, const glm::dvec2& upper) {
  scenes::Scene scene;
  add_object(scene, "floor", quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  const glm::dvec2 middle = 0.5 * (lower + upper), half = 0.5 * (upper - lower);
  add_object(scene, "board", quad({middle.x, kBoardHeight, middle.y}, {half.x, 0, 0}, {0, 0, -half.y}));
  scene.lights.push_back(ceiling_light(kBoardLightHeight, kBoardLightHalf));
  scene.cameras.push_back(camera({0.2, 0.9, 5.1}, {0.1, 0, 0.3}, 60));
  return scene;
}

inline bool is_on_floor(const Stage& stage, std::size_t pixel) {
  const std::int32_t triangle = stage.samples.triangle[pixel];
  return triangle != visibility::ViewSamples::kBackground && triangle < 2;
}

struct BoardPairs {
  std::size_t pairs = 0, hidden = 0, wrong = 0, within_rounding = 0;
};

/// Compares masks with the board as stored: a segment p→l is hidden if it crosses the board's height inside the board.
/// Pairs that cross it within `rounding` of its edge (world units) are counted apart; computed in double, the crossing
/// itself is off by a few ulps only.
inline BoardPairs compare_with_board(const Stage& stage, const Masks& masks, double rounding) {
  glm::dvec3 lower(stage.floats.positions.back()), upper = lower;
  for (const std::uint32_t triangle : {2U, 3U}) {
    for (const glm::vec3& corner : stage.floats.corners(triangle)) {
      lower = glm::min(lower, glm::dvec3(corner));
      upper = glm::max(upper, glm::dvec3(corner));
    }
  }
  BoardPairs result;
  for (std::size_t pixel = 0; pixel < stage.samples.size(); ++pixel) {
    if (!is_on_floor(stage, pixel)) continue;
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

inline void expect_board(const BoardPairs& found, std::size_t least_hidden, double most_within_rounding) {
  EXPECT_GT(found.pairs, 500000U);
  EXPECT_GT(found.hidden, least_hidden);
  EXPECT_EQ(found.wrong, 0U) << "of " << found.pairs << ", " << found.within_rounding << " within rounding";
  EXPECT_LE(static_cast<double>(found.within_rounding), most_within_rounding * static_cast<double>(found.pairs));
}

/// The share of the light [−1, 1]² that a board of ±`half` hides from p = (x, 0, z): seen from p the board's corners
/// fall on the light's plane at p + (corner − p) · light height / board height, and stay an axis-aligned rectangle.
inline double share_hidden_by_board(const glm::dvec3& p, const glm::dvec2& half) {
  const double scale = kBoardLightHeight / kBoardHeight;
  const auto overlap = [&](double half_size, double at) {
    const double low = std::max(at + scale * (-half_size - at), -kBoardLightHalf),
                 high = std::min(at + scale * (half_size - at), kBoardLightHalf);
    return std::max(0.0, high - low) / (2 * kBoardLightHalf);
  };
  return overlap(half.x, p.x) * overlap(half.y, p.z);
}

/// Expects that V on the floor converges to the exact area as the light gets more samples (in rows).
inline void expect_board_share_converges(const std::function<Masks(const Stage&)>& masks_of) {
  const glm::dvec2 size(0.19, 0.3);
  double previous = 1;
  for (const std::uint32_t side : {4U, 8U, 16U, 32U, 64U}) {
    const Stage stage(board_scene(-size, size), 64, 64, {side * side, 0, 0, visibility::SamplePattern::rows, 0});
    const Masks masks = masks_of(stage);
    double squares = 0, worst = 0;
    int count = 0;
    for (std::size_t pixel = 0; pixel < stage.samples.size(); ++pixel) {
      if (!is_on_floor(stage, pixel)) continue;
      const double hidden = share_hidden_by_board(glm::dvec3(stage.samples.p[pixel]) + stage.floats.origin, size);
      if (hidden == 0) continue;
      const double error = masks.visibility[pixel] - (1 - hidden);
      squares += error * error;
      worst = std::max(worst, std::abs(error));
      ++count;
    }
    ASSERT_GT(count, 30);
    // A sample stands for its row's height and its cell's width. Across the rows the count is off by less than one row
    // of 1 / side (half a row at each of two edges), along each row by less than one cell of 1 / side².
    EXPECT_LE(worst, 2.0 / side) << side;
    const double rmse = std::sqrt(squares / count);
    testing::Test::RecordProperty("rmse" + std::to_string(side * side), std::to_string(rmse));
    EXPECT_LT(rmse, 0.8 * previous) << side;
    previous = rmse;
  }
  EXPECT_LT(previous, 0.003);
}

}  // namespace penumbra::tests
