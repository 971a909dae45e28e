#pragma once

#include "import/gltf/gltf_nodes.hpp"
#include "scenes/losses.hpp"
#include "scenes/scene.hpp"

#include <glm/vec3.hpp>

#include <span>

namespace tinygltf {
class Node;
}

namespace penumbra::scenes {

/// A node's camera, without a name: perspective, or orthographic. Throws InputError for one that does not exist, or
/// that shows nothing.
Camera camera_of(const tinygltf::Model& model, const tinygltf::Node& node, const PlacedNode& placed, Losses& losses);

/// From above the front right, at the distance at which the bounding sphere just fits into the picture. `positions`:
/// not empty.
Camera camera_that_sees_all(std::span<const glm::dvec3> positions);

}  // namespace penumbra::scenes
