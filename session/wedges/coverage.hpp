// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"
#include "volumes/wedges/coverage_validation.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::session {

/// Results of `wedges --validate` on sums over silhouettes.
struct CoverageOutcome {
  std::vector<volumes::CoveragePoint> points;
  std::vector<double> hidden;  ///< for each point, the exact area of the union
  bool textured = false;       ///< areas are weights
};

/// Checks the invariant `coverage` at up to 64 judged pixels of the scene's first camera and size where an edge appears
/// on the light, chosen evenly from a grid of 32 × 32: against the areas of triangles, and the exact area of their
/// union.
CoverageOutcome check_scene_coverage(const scenes::Scene& scene, const visibility::SceneFloats& floats,
                                     const visibility::Light& light, const volumes::Casters& casters,
                                     volumes::ValidationReport& report);

}  // namespace penumbra::session
