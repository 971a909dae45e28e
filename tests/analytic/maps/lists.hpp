// SPDX-License-Identifier: Apache-2.0
#pragma once
// Support for tests of lists of depths: deep-penumbra's steps and layered-attenuation's layers.

#include "maps/sampling/methods.hpp"
#include "selftest/list_checks.hpp"
#include "tests/analytic/maps/parallel_square.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::tests {

/// A board and a sphere over a floor; the wall reaches above the light, so that hemicubes are needed.
inline scenes::Scene crowded(bool wall, bool two_sided) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, -3});
  add_object(scene, "sphere", sphere({0.3, 1, 0.2}, 0.6, 8));
  add_quad(scene, {-0.8, 2.5, 0.3}, {0.7, 0.2, 0}, {0, 0.1, 0.5});
  if (wall) add_quad(scene, {3, 3, 0}, {0, 3, 0}, {0, 0, 3});
  if (two_sided) {
    add_quad(scene, {0, 8, 0}, {3, 0, 0}, {0, 0, 3});
    add_quad(scene, {0.5, 6.5, 0}, {0.5, 0, 0}, {0, 0, 0.5});
  }
  scene.lights.push_back(ceiling_light(5, 0.5));
  scene.lights.back().two_sided = two_sided;
  scene.cameras.push_back(camera({0, 4, 7}, {0, 1, 0}, 60));
  return scene;
}

class MapLists : public MapsTest {
 protected:
  using Made = selftest::ListSource;
  static std::vector<std::uint32_t> words_of(const render::Buffer& buffer) {
    std::vector<std::uint32_t> words(buffer.bytes() / sizeof(std::uint32_t));
    buffer.read<std::uint32_t>(words);
    return words;
  }
};

/// RMSE over all pixels but the background.
inline double distance(const Stage& stage, const Masks& a, const Masks& b) {
  return rmse(
      stage, [&](std::size_t i) { return stage.samples.triangle[i] >= 0; },
      [&](std::size_t i) { return static_cast<double>(a.visibility[i]) - static_cast<double>(b.visibility[i]); });
}

}  // namespace penumbra::tests
