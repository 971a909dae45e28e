// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"
#include "session/wedges/coverage.hpp"
#include "session/wedges/report.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "volumes/wedges/wedge_tightness.hpp"
#include "volumes/wedges/wedge_validation.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::session {

/// Wedges to be built, as given by the user.
struct WedgeRequest {
  std::string light = {};                 ///< empty: the scene's first
  std::string construction = "original";  ///< original, tight, or broken:1 to broken:6
  std::string from = "centre";            ///< centre or anywhere
  bool validate = false;                  ///< prove every invariant
  /// Called between the steps of the work; its exception ends the work. Null: none.
  const std::function<void(double done)>* step = nullptr;
};

/// Wedges of the edges that cast penumbrae of one light.
struct LightWedges {
  volumes::LightHull hull;
  volumes::CastingEdges casting;
  std::vector<volumes::Wedge> wedges;
};

/// Throws InputError for a light that is infinitely far away: it has no wedges.
void require_wedges(const visibility::Light& light);
/// Builds the wedges of `light` by the request's `construction` and `from`. Throws UsageError if these are invalid.
LightWedges wedges_of(const volumes::Casters& casters, const visibility::Light& light, const WedgeRequest& request);

/// Wedges of one light of a scene, and the results of their proofs. Not movable, because its result refers to it.
class BuiltWedges {
 public:
  /// Memory for each triangle, in addition to the scene: measured on a sphere of a million triangles, and rounded down.
  static constexpr std::uint64_t kBytesPerTriangle = 150;

  /// Builds and validates the wedges. Coverage is checked for the scene's first camera and size. Throws UsageError for
  /// an invalid request, InputError for a light without wedges.
  BuiltWedges(const scenes::Scene& scene, const WedgeRequest& request);
  BuiltWedges(const BuiltWedges&) = delete;
  BuiltWedges& operator=(const BuiltWedges&) = delete;

  /// Returns the result, which refers to this object.
  [[nodiscard]] WedgesResult result() const;
  [[nodiscard]] bool holds() const { return !report || report->violations.empty(); }

  WedgeRequest request;
  visibility::SceneFloats floats;
  visibility::Light light;
  volumes::LightHull hull;
  volumes::Casters casters;
  volumes::CastingEdges casting;
  std::vector<volumes::Wedge> wedges;
  std::optional<volumes::ValidationReport> report;  ///< set if validated, as the next two
  std::optional<volumes::Tightness> tightness;
  std::optional<CoverageOutcome> coverage;
  std::vector<std::string> warnings;
};

}  // namespace penumbra::session
