// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "areas/exact_area.hpp"
#include "tests/unit/exact_area_scenes.hpp"
#include "volumes/wedges/layer_areas.hpp"
#include "volumes/wedges/soft_visibility.hpp"

#include <utility>
#include <vector>

namespace penumbra::tests {

/// Soft shadow volumes and exact areas of a scene's first light.
struct CoverageStage {
  explicit CoverageStage(const scenes::Scene& scene)
      : floats(visibility::make_scene_floats(scene)),
        light(visibility::make_light(scene, 0, floats.origin, {1})),
        casters(volumes::casters_of(floats, light)),
        soft(floats, light, casters),
        area(floats) {
    area.set_light(light);
  }
  CoverageStage(const CoverageStage&) = delete;
  CoverageStage& operator=(const CoverageStage&) = delete;

  /// Returns p as a point on the carrier, triangle 0, seen from above.
  [[nodiscard]] volumes::LitPoint lit(const glm::vec3& p) const {
    const areas::Receiver receiver = receiver_at(floats, p);
    return {receiver.p, receiver.carrier, receiver.facing};
  }
  [[nodiscard]] volumes::LayerSum center(const glm::vec3& p) const { return soft.at(lit(p), volumes::Viewer::center); }
  [[nodiscard]] volumes::LayerSum receiver(const glm::vec3& p) const {
    return soft.at(lit(p), volumes::Viewer::receiver);
  }
  [[nodiscard]] double exact(const glm::vec3& p) const { return area.visibility(receiver_at(floats, p)); }
  [[nodiscard]] std::vector<std::vector<glm::dvec2>> layers(const glm::vec3& p) const {
    return volumes::projected_layers(light, p, soft.layers(lit(p)));
  }

  visibility::SceneFloats floats;
  visibility::Light light;
  volumes::Casters casters;
  volumes::SoftVisibility soft;
  areas::ExactArea area;
};

/// Returns a shape's triangles as corners, for add_object.
inline std::vector<Corners> corners_of(const mesh::TriangleSoup& soup) {
  std::vector<Corners> result;
  for (const mesh::Triangle& t : soup.triangles) {
    result.push_back({soup.positions[t[0]], soup.positions[t[1]], soup.positions[t[2]]});
  }
  return result;
}

}  // namespace penumbra::tests
