// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"
#include "volumes/wedges/wedge_tightness.hpp"
#include "volumes/wedges/wedge_validation.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

/// Support for tests of validation: meshes as casters, a light of each kind, and the whole check.
namespace penumbra::volumes::test {

/// Returns a light of each kind about `center`, above the casters; stored relative to zero.
inline std::vector<visibility::Light> lights_at(const glm::dvec3& center, double size) {
  const glm::dvec3 u(size, 0, 0.25 * size), v(-0.125 * size, 0.25 * size, size);
  scenes::Scene scene;
  scene.lights = {
      {"rectangle", scenes::Rectangle{center, v, u}, glm::dvec3(1), false},
      {"disk", scenes::Disk{center, glm::dvec3(0, -1, 0), size}, glm::dvec3(1), false},
      {"ellipse", scenes::Ellipse{center, v, 0.5 * u}, glm::dvec3(1), false},
      {"polygon", scenes::Polygon{{center, center + u, center + 0.5 * (u + v), center + v}}, glm::dvec3(1), false},
      {"sphere", scenes::Sphere{center, size}, glm::dvec3(1), false}};
  std::vector<visibility::Light> lights;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    lights.push_back(visibility::make_light(scene, i, glm::dvec3(0), {}));
  }
  return lights;
}

struct Validated {
  CastingEdges casting;
  std::vector<Wedge> wedges;
  ValidationReport report;
};

inline Validated validated(const Casters& casters, const LightHull& light, Construction construction,
                           SilhouettesFrom from) {
  const bool tight = construction == Construction::tight;
  Validated result{casting_edges(casters, light, from, tight && from == SilhouettesFrom::anywhere), {}, {}};
  result.wedges = build_wedges(result.casting.wedges, light, construction);
  result.report = validate({casters, result.casting, light, result.wedges, tight});
  return result;
}

inline std::string text_of(const Violation& violation) {
  return std::string(name_of(violation.invariant)) + ", wedge " +
         (violation.wedge ? std::to_string(*violation.wedge) : "none") + ": " + violation.what + ", by " +
         std::to_string(violation.distance);
}

/// Counts of what was checked, so that a test can expect that there was something to check.
struct Total {
  std::uint64_t wedges = 0, planes = 0, crops = 0;
};

/// Checks both constructions, with silhouettes from the centre and from anywhere on the light.
inline Total expect_valid(const Casters& casters, const LightHull& light, const std::string& name) {
  Total total;
  for (const Construction construction : {Construction::original, Construction::tight}) {
    for (const SilhouettesFrom from : {SilhouettesFrom::center, SilhouettesFrom::anywhere}) {
      const Validated result = validated(casters, light, construction, from);
      if (!result.report.violations.empty()) {
        ADD_FAILURE() << name << (construction == Construction::tight ? ", tight" : ", original")
                      << (from == SilhouettesFrom::center ? ", centre: " : ", anywhere: ")
                      << result.report.violations.size() << " violations; " << text_of(result.report.violations[0]);
      }
      total.wedges += result.wedges.size();
      total.planes += result.report.checks[static_cast<std::size_t>(Invariant::conservative)];
      total.crops += result.report.cropped_planes;
    }
  }
  return total;
}

}  // namespace penumbra::volumes::test
