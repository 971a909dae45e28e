// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "selftest/small_scenes.hpp"

namespace penumbra::selftest {

/// Returns a scene for tests of maps of every kind: a floor, a sphere of small triangles and a tilted board below a
/// light; a wall up to the light, where maps become hemicubes; and a second half above a two-sided light.
inline scenes::Scene crowd(bool wall, bool two_sided) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -2});
  add_object(scene, "sphere", sphere({0.31, 1.07, 0.23}, 0.61, 8));
  add_quad(scene, {-0.7, 1.5, 0.1}, {0.43, 0.21, 0}, {0, 0, 0.77});
  if (wall) add_quad(scene, {2, 2, 0}, {0, 2, 0}, {0, 0, 2});
  if (two_sided) {
    add_quad(scene, {0, 6, 0}, {2, 0, 0}, {0, 0, 2});
    add_quad(scene, {0.2, 5, 0}, {0.5, 0.1, 0}, {0, 0, 0.5});
  }
  scene.lights.push_back(ceiling_light(3, 0.5));
  scene.lights.back().two_sided = two_sided;
  scene.cameras.push_back(camera({0, 3, 8}, {0, 1, 0}));
  return scene;
}

}  // namespace penumbra::selftest
