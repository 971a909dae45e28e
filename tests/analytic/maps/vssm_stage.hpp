// SPDX-License-Identifier: Apache-2.0
#pragma once

// Support for tests of vssm: a scene, the method's options for its twin's settings, and the test suite.

#include "tests/analytic/maps/vssm_twin.hpp"

#include <fmt/format.h>

#include <vector>

namespace penumbra::tests {

inline constexpr std::uint32_t kMapSize = 128;

/// Returns the margin around the receivers that the methods need in their map.
inline glm::dvec2 beside(const Stage& stage) {
  return maps::half_extent(stage.light, maps::light_basis(stage.light)) / maps::half_width(stage.light);
}

inline visibility::MethodOptions options_of(const VssmSettings& settings, std::uint32_t size = kMapSize) {
  return {{"size", fmt::format("{}", size)},
          {"moments", settings.moments},
          {"layers", fmt::format("{}", settings.moments == "lvsm" ? settings.count : 4)},
          {"terms", fmt::format("{}", settings.moments == "csm" ? settings.count : 16)},
          {"exponent", fmt::format("{}", settings.exponent)},
          {"scale", fmt::format("{}", settings.scale)},
          {"leak", fmt::format("{}", settings.leak)},
          {"bias", fmt::format("{}", settings.bias)},
          {"offset", fmt::format("{}", settings.offset)},
          {"damping", fmt::format("{}", settings.damping)},
          {"subdivision", settings.subdivision},
          {"cuts", fmt::format("{}", settings.cuts)},
          {"window", fmt::format("{}", settings.window)},
          {"receiverPlane", settings.receiver_plane ? "on" : "off"},
          {"leakCut", settings.smooth_leak ? "smoothstep" : "linear"},
          {"fallback", settings.fallback ? "on" : "off"}};
}

/// A floor, a sphere and two boards above it, one of them tilted.
inline scenes::Scene scene_with(const decltype(scenes::AreaLight::shape)& shape) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -2});
  add_object(scene, "sphere", sphere({0.5, 0.8, 0.3}, 0.5, 8));
  add_quad(scene, {-0.8, 1.5, 0}, {0.4, 0, 0}, {0, 0, 0.9});
  add_quad(scene, {-0.5, 0.5, -0.6}, {0.5, 0.2, 0}, {0, 0, 0.5});
  scene.lights.push_back(ceiling_light(4, 0.5));
  scene.lights.back().shape = shape;
  scene.cameras.push_back(camera({0, 5, 4}, {0, 0, 0}, 40));
  return scene;
}

/// A board parallel to the floor and the light that reaches beyond the floor along z.
struct Strip {
  double height, x0, x1;
};
/// Returns a floor under these boards.
inline scenes::Scene under_strips(const std::vector<Strip>& boards, double light = 0.5) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, 2});
  for (const Strip& board : boards) {
    add_quad(scene, {(board.x0 + board.x1) / 2, board.height, 0}, {(board.x1 - board.x0) / 2, 0, 0}, {0, 0, 3})
        .receives_shadow = false;
  }
  scene.lights.push_back(ceiling_light(4, light));
  scene.cameras.push_back(camera({0, 1, 3}, {0, 0, 0}));
  return scene;
}

/// Returns 48 × 48 view samples around the middle of such a floor.
inline Stage floor_stage(const std::vector<Strip>& boards, double light = 0.5) {
  return {under_strips(boards, light), 48, 48, light_samples(1),
          grid_samples(48, {0, 0, 0}, {1.2, 0, 0}, {0, 0, 1.2}, {0, 1, 0})};
}

class Vssm : public MapsTest {};

}  // namespace penumbra::tests
