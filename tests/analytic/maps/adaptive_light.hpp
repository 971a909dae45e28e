// SPDX-License-Identifier: Apache-2.0
#pragma once

// Support for tests of adaptive-light: its pictures with their counters, a sphere over a floor, and its errors
// there.

#include "tests/analytic/maps/backprojection_scenes.hpp"

#include "maps/products/light_shape.hpp"
#include "maps/sampling/methods.hpp"
#include "reference/methods.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace penumbra::tests {

using visibility::MethodOptions;

class AdaptiveLight : public MapsTest {
 protected:
  struct Run {
    Masks picture;
    std::uint64_t maps = 0, comparisons = 0;
  };
  /// Runs adaptive-light with epsilon as published: a share of the map's texels.
  static Run adaptive(const Stage& stage, MethodOptions options, std::uint32_t rows_at_once = 0) {
    options.emplace("size", "128");
    options.emplace("shareOf", "map");
    const auto method = maps::make_adaptive_light(device(), options);
    Run result{run(*method, stage, rows_at_once)};
    const auto counters = method->counters();
    result.maps = counters.at("maps");
    result.comparisons = counters.at("comparisons");
    return result;
  }
  /// A sphere of radius 1 over a floor, the light 3 above its centre; `away` multiplies the camera's distance.
  static scenes::Scene sphere_scene(double half, double away = 1) {
    scenes::Scene scene;
    add_quad(scene, {0, 0, 0}, {4, 0, 0}, {0, 0, -4});
    add_object(scene, "sphere", sphere({0, 2, 0}, 1, 12));
    scene.lights.push_back(ceiling_light(5, half));
    scene.cameras.push_back(camera(away * glm::dvec3(0, 4, 7), {0, 0.5, 0}, 60));
    return scene;
  }
  /// The points of a fully refined light, in rows.
  static std::vector<glm::vec3> corner_grid(const visibility::Light& light, int across) {
    const maps::LightSquare square(light);
    std::vector<glm::vec3> points;
    for (int y = 0; y < across; ++y) {
      for (int x = 0; x < across; ++x) {
        points.push_back(square.at(glm::dvec2(x, y) / (across - 1.0)));
      }
    }
    return points;
  }
  /// RMSE over the floor (the first object) against the exact areas.
  double floor_rmse(const Stage& stage, const Masks& picture, const Masks& exact) {
    return rmse(
        stage, [&](std::size_t i) { return on_floor(stage, i); },
        [&](std::size_t i) {
          return static_cast<double>(picture.visibility[i]) - static_cast<double>(exact.visibility[i]);
        });
  }
  static bool on_floor(const Stage& stage, std::size_t i) {
    return stage.samples.triangle[i] >= 0 &&
           stage.floats.object[static_cast<std::size_t>(stage.samples.triangle[i])] == 0;
  }
  static Masks exact(const Stage& stage) { return tests::run(*reference::make_exact({}), stage); }
  static visibility::Light with_points(visibility::Light light, std::vector<glm::vec3> points) {
    light.coordinates.assign(points.size(), glm::dvec2(0));
    light.points = std::move(points);
    light.rows = light.columns = 0;
    light.row_shift.clear();
    return light;
  }
};

}  // namespace penumbra::tests
