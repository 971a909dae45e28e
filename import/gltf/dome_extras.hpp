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

/// Returns the dome described by a node's extras, without a name: "dome": {"radiance": [red, green, blue], "half": true
/// or false, "visible": true or false, "sampled": true or false, "image": the name of a picture next to the file}; all
/// but the radiance are optional. The node's +Y is up, and its −Z is the direction of the picture's middle column; its
/// position and scale are ignored. The picture itself is not read here. An entry without a radiance belongs to another
/// tool, and is added to the losses. Throws InputError for invalid values, and for a node that is mirrored or has no
/// axes.
std::optional<scenes::AreaLight> dome_of(const tinygltf::Node& node, const PlacedNode& placed, scenes::Losses& losses);

}  // namespace penumbra::import
