// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/unit/visibility/scenes.hpp"

namespace penumbra::tests {

/// Returns a panel, 2.4 wide and 1.2 high, that stands just above the floor, with a board, a post and a shelf in front
/// of it.
inline scenes::Scene things_before_a_panel() {
  scenes::Scene scene;
  add_object(scene, "floor", quad({0, 0, 0.5}, {2.5, 0, 0}, {0, 0, -1.5}));
  add_object(scene, "board", quad({-0.6, 0.25, -0.7}, {0.25, 0, 0.1}, {0, 0.25, 0}));
  add_object(scene, "post", quad({0.15, 0.6, -0.75}, {0.06, 0, 0}, {0, 0.6, 0}));
  add_object(scene, "shelf", quad({0.8, 0.12, -0.65}, {0.3, 0, 0}, {0, 0.03, 0.2}));
  scene.lights.push_back(rectangle_light({0, 0.61, -1.01}, {1.2, 0, 0}, {0, 0.6, 0}));
  scene.lights[0].radiance = glm::dvec3(1);
  scene.cameras.push_back(camera({0.4, 2.2, 1.9}, {0, 0, -0.3}));
  return scene;
}

}  // namespace penumbra::tests
