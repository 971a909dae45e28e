// SPDX-License-Identifier: Apache-2.0
#pragma once

// Support for tests of soft-shadow-map: its pictures with their counters, floors with a light above, and the paper's
// measure of error.

#include "tests/analytic/maps/parallel_square.hpp"

#include "maps/backprojection/soft_shadow_map/methods.hpp"
#include "reference/methods.hpp"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace penumbra::tests {

using visibility::MethodOptions;

class SoftShadowMap : public MapsTest {
 protected:
  struct Run {
    Masks picture;
    std::uint64_t patches, fragments;
  };
  static Run soft(const Stage& stage, const MethodOptions& options = {}, std::uint32_t rows_at_once = 0) {
    const auto method = maps::make_soft_shadow_map(device(), options);
    Masks picture = run(*method, stage, rows_at_once);
    const auto counters = method->counters();
    return {std::move(picture), counters.at("patches"), counters.at("fragments")};
  }
  static bool on_object(const Stage& stage, std::size_t i, std::uint32_t object) {
    return stage.samples.triangle[i] >= 0 &&
           stage.floats.object[static_cast<std::size_t>(stage.samples.triangle[i])] == object;
  }
  /// View samples on the floor (object 0, at height 0) at these places.
  static Stage on_floor(const scenes::Scene& scene, const std::vector<glm::dvec2>& places) {
    return Stage(scene, static_cast<std::uint32_t>(places.size()), 1, light_samples(1),
                 [&](const visibility::SceneFloats& floats, const visibility::PinholeCamera& /*camera*/) {
                   visibility::ViewSamples samples;
                   samples.width = static_cast<std::uint32_t>(places.size());
                   samples.height = 1;
                   for (const glm::dvec2& place : places) {
                     samples.triangle.push_back(0);
                     samples.p.emplace_back(glm::dvec3(place.x, 0, place.y) - floats.origin);
                     samples.n.emplace_back(0, 1, 0);
                     samples.depth.push_back(1);
                     samples.facing.push_back(1);
                   }
                   return samples;
                 });
  }
  /// A floor of half-size 4, and 5 above it a light of half-size `half`.
  static scenes::Scene floor_and_light(double half) {
    scenes::Scene scene;
    add_quad(scene, {0, 0, 0}, {4, 0, 0}, {0, 0, -4});
    scene.lights.push_back(ceiling_light(5, half));
    scene.cameras.push_back(camera({0, 4, 7}, {0, 0.5, 0}, 60));
    return scene;
  }
  static scenes::Scene ball(double half, double height = 2) {
    scenes::Scene scene = floor_and_light(half);
    add_object(scene, "sphere", sphere({0, height, 0}, 1, 16));
    return scene;
  }
  /// The measure of the paper's section 5.2.1 over the floor: the sum of abs(V - V_ref) over the number of pixels in
  /// umbra or penumbra. Also the areas of the umbrae, found and true.
  struct Measure {
    double error, umbra, true_umbra;
  };
  static Measure measure(const Stage& stage, const Masks& found, const Masks& truth) {
    Measure result{0, 0, 0};
    double shaded = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!on_object(stage, i, 0)) continue;
      result.error += static_cast<double>(std::abs(found.visibility[i] - truth.visibility[i]));
      shaded += truth.visibility[i] < 1 ? 1 : 0;
      result.umbra += found.visibility[i] < 0.05F ? 1 : 0;
      result.true_umbra += truth.visibility[i] < 0.05F ? 1 : 0;
    }
    result.error /= shaded;
    return result;
  }
  static Masks exact(const Stage& stage) { return tests::run(*reference::make_exact({}), stage); }
};

}  // namespace penumbra::tests
