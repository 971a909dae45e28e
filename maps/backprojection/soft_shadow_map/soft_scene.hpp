#pragma once

#include "maps/host/light_basis.hpp"
#include "maps/host/map_view.shared.h"
#include "visibility/scene_floats.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::maps {

/// Who shades and who is shaded: Atty et al. 2006 keep the two apart ("self shadowing is not accounted for").
/// Receivers are the objects that receive shadow and cast none; where there is none, the object with the largest area
/// toward the light. All else that casts shadow is an occluder. One entry a triangle each.
struct SoftScene {
  std::vector<std::uint8_t> occluders, receivers;
};
SoftScene part_scene(const visibility::SceneFloats& scene, const visibility::Light& light, const LightBasis& basis);

/// A view from the light's centre of the chosen triangles alone: one window a side of the light's plane, as wide as
/// they are in x/z and y/z and no wider than ±4; face_count 0 where there is nothing on a side. A texel is added all
/// around.
gpu::LightView fit_window(const visibility::SceneFloats& scene, const LightBasis& basis,
                          std::span<const std::uint8_t> chosen, std::uint32_t size, bool two_sided);

}  // namespace penumbra::maps
