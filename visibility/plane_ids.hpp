// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/scene_floats.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::visibility {

/// Returns for each triangle a number that it shares with exactly those triangles that are exactly coplanar with it
/// (the index of one of them); SceneFloats::kNoPlane for zero area. Reads positions and triangles only.
std::vector<std::uint32_t> plane_ids(const SceneFloats& scene);

}  // namespace penumbra::visibility
