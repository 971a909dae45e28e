// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/view/live_renderer.hpp"
#include "app/view/space_shadows.hpp"
#include "visibility/scene_floats.hpp"
#include "volumes/wedges/wedge_casters.hpp"

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

namespace penumbra::app {

/// Answers the requests of the page's 3D view (docs/view.md) about the renderer's current scene and lights. Scene
/// floats and the casters of the last light are kept, for as long as the scene's meshes are the same. Thread-safe.
class SpaceView {
 public:
  explicit SpaceView(const LiveRenderer& renderer) : renderer_(renderer) {}

  // The following functions throw UsageError for scenes with instances without copies.
  std::string meshes();
  std::string defects();
  /// `target`: the request's target, with the parameters light, construction, from, s, t, floor, wedge, and x and y of
  /// a pixel. For a light that cannot have wedges, the header contains the reason in `refused`. Throws UsageError for
  /// an invalid parameter.
  std::string shadows(std::string_view target);

 private:
  const visibility::SceneFloats& floats_of(const LiveScenery& scenery);
  const volumes::Casters& casters_of(const LiveScenery& scenery, const visibility::Light& light);

  const LiveRenderer& renderer_;
  std::mutex mutex_;  // guards the members below
  std::shared_ptr<const WholeScene> scene_;
  visibility::SceneFloats floats_;  // of scene_
  volumes::Casters casters_;
  struct CastersOf {
    std::int32_t light = 0;
    std::vector<std::uint8_t> unshaded_by;
    bool operator==(const CastersOf&) const = default;
  };
  std::optional<CastersOf> casters_of_;  // nullopt: casters_ is not valid for any light
};

/// Returns the request in a target's parameters; `point` is not set. Throws UsageError.
SpaceShadows parse_space_shadows(std::string_view target);

}  // namespace penumbra::app
