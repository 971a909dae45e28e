// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "import/gltf/gltf_nodes.hpp"
#include "scenes/losses.hpp"
#include "scenes/scene.hpp"

#include <glm/vec3.hpp>

#include <span>

namespace tinygltf {
class Node;
}

namespace penumbra::import {

/// Returns a node's camera, perspective or orthographic, without a name. Throws InputError for a camera that does not
/// exist, or that shows nothing.
scenes::Camera camera_of(const tinygltf::Model& model, const tinygltf::Node& node, const PlacedNode& placed,
                         scenes::Losses& losses);

}  // namespace penumbra::import
