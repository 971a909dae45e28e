// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/agreement/support.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace penumbra::tests {

/// Returns a ball of about 240 triangles, of which one in sixteen is missing.
inline std::vector<Corners> cracked_ball(const glm::dvec3& middle, double radius, std::mt19937& random) {
  const auto on_ball = [&](int i, int j) {
    const double a = i * std::numbers::pi / 8, b = j * std::numbers::pi / 8;
    return middle + radius * glm::dvec3(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b));
  };
  std::vector<Corners> ball;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 16; ++j) {
      if (random() % 16 == 0) continue;
      ball.push_back({on_ball(i, j), on_ball(i + 1, j), on_ball(i + 1, j + 1)});
      ball.push_back({on_ball(i, j), on_ball(i + 1, j + 1), on_ball(i, j + 1)});
    }
  }
  return ball;
}

}  // namespace penumbra::tests
