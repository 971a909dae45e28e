// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/scene_floats.hpp"

#include <cstdint>

namespace penumbra::visibility {

/// Memory of the scene floats for each triangle, without positions: SceneFloats' lists, and those that
/// make_scene_floats sorts triangles with.
inline constexpr std::uint64_t kFloatsOfTriangle = sizeof(Triangle) + 6 * sizeof(std::uint32_t) + 2;

}  // namespace penumbra::visibility
