#pragma once

#include "maps/light_frame.hpp"
#include "maps/map_view.shared.h"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::maps {

/// The views of several points of one light. All have the same faces, so that their maps are equally large.
struct FittedViews {
  std::vector<gpu::LightView> views;
  std::uint32_t faces = 0;  ///< of one light point: 0 … 10
};

/// Fits each point's maps to the receivers of the scene, so that no receiver on an emitting side is ever outside.
/// Depends on mesh and light only, not on the camera. `size`: texels on a side of a face.
FittedViews fit_views(const visibility::SceneFloats& scene, const visibility::Light& light, const LightFrame& frame,
                      std::span<const glm::vec3> points, std::uint32_t size);

/// What caster.vert needs for one face of a view; `first_vertex` is the caller's.
gpu::CasterPush face_push(const gpu::LightView& view, const LightFrame& frame, std::uint32_t face);

}  // namespace penumbra::maps
