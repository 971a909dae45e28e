#pragma once

#include "import/gltf/gltf_nodes.hpp"
#include "scenes/losses.hpp"
#include "scenes/scene.hpp"

#include <optional>

namespace tinygltf {
class Node;
}

namespace penumbra::scenes {

/// The dome that a node's extras describe, without a name: "dome": {"radiance": [red, green, blue], "half": true or
/// false, "visible": true or false, "image": the name of a picture beside the file}; all but the radiance may be left
/// out. The node's +Y is up, and its −Z is where the middle column of the picture lies; its place and its scale mean
/// nothing. The picture itself is not read here. An entry without a radiance is another tool's, and goes to the losses.
/// Throws InputError for values that are wrong, and for a node that is mirrored or has no axes.
std::optional<AreaLight> dome_of(const tinygltf::Node& node, const PlacedNode& placed, Losses& losses);

}  // namespace penumbra::scenes
