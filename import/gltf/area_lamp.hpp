// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "import/gltf/gltf_nodes.hpp"
#include "scenes/losses.hpp"
#include "scenes/scene.hpp"

#include <optional>

namespace tinygltf {
class Node;
}

namespace penumbra::import {

/// Returns the area lamp that a node's extras describe (glTF has none), without a name. "areaLamp": {"shape":
/// "rectangle" or "ellipse", "size": [width, height] along the node's X and Y, "radiance": [red, green, blue]}. The
/// lamp lies in the node's XY plane around its origin, rotated and scaled by the node's transform, and shines along −Z;
/// it is invisible and occludes nothing. Extras that lack one of the three keys belong to another tool, and are added
/// to the losses. Throws InputError for invalid values, and for a lamp without area after the transform.
std::optional<scenes::AreaLight> area_lamp_of(const tinygltf::Node& node, const PlacedNode& placed,
                                              scenes::Losses& losses);

}  // namespace penumbra::import
