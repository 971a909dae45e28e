// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/unit/visibility/scenes.hpp"

#include <random>

namespace penumbra::tests {

/// Makes `triangles` small triangles anywhere around the origin, over a tilted floor that receives their shadows. No
/// triangle is parallel to an axis.
inline scenes::Scene soup_over_tilted_floor(std::mt19937& random, int triangles) {
  std::uniform_real_distribution<double> real(-1, 1);
  const auto point = [&](double size) { return size * glm::dvec3(real(random), real(random), real(random)); };
  scenes::Scene scene;
  add_object(scene, "floor", quad({0, -1.37, 0}, {3.1, 0.1, 0}, {0, 0.2, -2.9}));
  std::vector<Corners> soup;
  for (int i = 0; i < triangles; ++i) {
    const glm::dvec3 center = point(1);
    soup.push_back({center + point(0.5), center + point(0.5), center + point(0.5)});
  }
  add_object(scene, "soup", soup);
  scene.cameras.push_back(camera({0.3, 1.5, 5}, {0, -0.3, 0}));
  return scene;
}

}  // namespace penumbra::tests
