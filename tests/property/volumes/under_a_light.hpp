// SPDX-License-Identifier: Apache-2.0
#pragma once

// View samples under a rectangle light in the form that methods on vector units get, for tests that compare bounds of
// error with exact places.

#include "engines/vectors/clusters.hpp"
#include "engines/vectors/light_grid.hpp"
#include "tests/agreement/support.hpp"
#include "visibility/lights/device_light.hpp"
#include "visibility/tree/tree_texels.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace penumbra::tests {

/// A scene's first light with 8 × 8 light samples, and the side to which u × v points.
struct UnderALight {
  explicit UnderALight(const scenes::Scene& scene, std::uint32_t cells = 8)
      : floats(visibility::make_scene_floats(scene)),
        light(visibility::make_light(scene, 0, floats.origin, {64, 8, 8, visibility::SamplePattern::rows, 0})),
        scale(visibility::device_scale(floats)),
        device_light(visibility::make_device_light(light, scale)),
        grid(vectors::make_light_grid({device_light,
                                       {scaled(light.center), scaled(light.center_u), scaled(light.center_v)},
                                       true,
                                       cells,
                                       cells,
                                       0,
                                       1,
                                       visibility::reach_of(floats, device_light, scale),
                                       0,
                                       scale,
                                       light.points})) {}

  [[nodiscard]] glm::dvec3 scaled(const glm::vec3& x) const { return glm::dvec3(x) * static_cast<double>(scale); }

  /// Returns view samples on the first triangle, side by side; nullopt unless all of them are in front of the light.
  [[nodiscard]] std::optional<std::vector<vectors::GridSample>> place(const std::vector<glm::vec3>& points) {
    const auto [a, b, c] = floats.corners(0);
    const glm::dvec3 normal = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
    samples = {};
    samples.width = static_cast<std::uint32_t>(points.size());
    samples.height = 1;
    for (const glm::vec3& p : points) {
      const bool front = glm::dot(normal, glm::dvec3(light.center) - glm::dvec3(p)) > 0;
      samples.triangle.push_back(0);
      samples.p.push_back(p + 0.0F);
      samples.n.emplace_back(glm::normalize(front ? normal : -normal));
      samples.depth.push_back(1);
      samples.facing.push_back(static_cast<std::int8_t>(front ? 1 : -1));
    }
    const vectors::KnownNormals known(floats);
    const vectors::ViewInput view{floats, samples, device_light, grid, known, scale};
    std::vector<vectors::GridSample> placed(points.size());
    for (std::uint32_t i = 0; i < placed.size(); ++i) {
      if (classify(view, i, placed[i]) != vectors::SampleClass::in_front) return std::nullopt;
    }
    return placed;
  }

  visibility::SceneFloats floats;
  visibility::Light light;
  float scale;
  visibility::DeviceLight device_light;
  vectors::LightGrid grid;
  visibility::ViewSamples samples;  ///< the view samples of the last place()
};

}  // namespace penumbra::tests
