// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/light_basis.hpp"
#include "maps/host/map_view.shared.h"
#include "maps/host/view_fit.hpp"
#include "visibility/scene_floats.hpp"

#include <glm/vec2.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::maps {

/// Triangles that cast shadow and triangles that receive shadow: Atty et al. 2006 keep the two apart ("self shadowing
/// is not accounted for"). Receivers are the objects that receive shadow and cast none; if there is no such object, the
/// object with the largest area toward the light. All other triangles that cast shadow are occluders. One entry for
/// each triangle.
struct SoftScene {
  std::vector<std::uint8_t> occluders, receivers;
};
SoftScene part_scene(const visibility::SceneFloats& scene, const visibility::Light& light, const LightBasis& basis);

/// Returns a view from the light's centre of the chosen triangles alone: one window for each side of the light's plane,
/// as wide as the triangles in x/z and y/z and no wider than ±4; face_count is 0 for an empty side. A margin of one
/// texel is added all around.
gpu::LightView fit_window(const visibility::SceneFloats& scene, const LightBasis& basis,
                          std::span<const std::uint8_t> chosen, std::uint32_t size, bool two_sided);

/// Points of receivers (SoftScene) seen by a camera, to which maps are fitted, and the other inputs of this fit.
struct SoftBody {
  std::span<const BodyPoint> points;
  glm::dvec2 reach{0};  ///< extent of the light from its centre along u and v
  std::uint32_t receiver_size = 0, occluder_size = 0;
  bool two_sided = false, snap = false;
};
struct SoftViews {
  gpu::LightView receivers, occluders;
};
/// Returns such views of the points alone, and of the occluders that can shade them: the part of the occluders' window
/// that can hide some of the light from a point. `snap`: texels stay in place while the body changes (snapped()).
SoftViews fit_to_camera(const visibility::SceneFloats& scene, const LightBasis& basis, const SoftScene& parts,
                        const SoftBody& body);

}  // namespace penumbra::maps
