// SPDX-License-Identifier: Apache-2.0
#pragma once

// Scenes and view samples for the tests of exact areas. All coordinates are multiples of 1/64 and the scene's bounding
// box is centred on 0: stored floats are the numbers written here.

#include "areas/exact_area.hpp"
#include "tests/unit/visibility/scenes.hpp"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <random>
#include <vector>

namespace penumbra::tests {

constexpr double kFrameSize = 32;  ///< two specks at plus and minus this size make the origin 0

/// A scene whose carrier is triangle 0: horizontal, at `height`, seen from above. Specks that cast no shadow fix the
/// origin.
inline scenes::Scene area_scene(const std::vector<Corners>& occluders, double height = 0) {
  scenes::Scene scene;
  add_object(scene, "floor", {{glm::dvec3(-30, height, -30), {-30, height, 30}, {30, height, 30}}});
  const auto speck = [](double at, double toward) {
    return Corners{glm::dvec3(at), {toward, at, at}, {at, toward, at}};
  };
  add_object(scene, "frame", {speck(-kFrameSize, -31), speck(kFrameSize, 31)}).casts_shadow = false;
  add_object(scene, "occluders", occluders);
  return scene;
}

inline double random_dyadic(std::mt19937& random, double low, double high, double step = 1.0 / 64) {
  const auto from = static_cast<int>(low / step), to = static_cast<int>(high / step);
  return step * std::uniform_int_distribution<int>(from, to)(random);
}

/// A view sample at p on the carrier, seen from the light's side.
inline areas::Receiver receiver_at(const visibility::SceneFloats& floats, const glm::vec3& p) {
  const auto [a, b, c] = floats.corners(0);
  const glm::dvec3 normal = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
  return {p, 0, static_cast<std::int8_t>(normal.y > 0 ? 1 : -1)};
}

/// A scene's exact areas for its first light.
struct AreaStage {
  explicit AreaStage(const scenes::Scene& scene, std::uint32_t samples = 1, std::uint32_t seed = 0)
      : floats(visibility::make_scene_floats(scene)),
        light(visibility::make_light(scene, 0, floats.origin,
                                     {samples, 0, 0, visibility::SamplePattern::jittered, seed})),
        area(floats) {
    area.set_light(light);
  }
  AreaStage(const AreaStage&) = delete;
  AreaStage& operator=(const AreaStage&) = delete;

  [[nodiscard]] double visibility(const glm::vec3& p,
                                  areas::SweepArithmetic arithmetic = areas::SweepArithmetic::rounded) const {
    return area.visibility(receiver_at(floats, p), arithmetic);
  }

  visibility::SceneFloats floats;
  visibility::Light light;
  areas::ExactArea area;
};

}  // namespace penumbra::tests
