#pragma once

#include "import/gltf/gltf_nodes.hpp"
#include "scenes/losses.hpp"
#include "scenes/scene.hpp"

#include <optional>

namespace tinygltf {
class Node;
}

namespace penumbra::scenes {

/// The area lamp that a node's extras describe, for glTF knows none; without a name. "areaLamp": {"shape": "rectangle"
/// or "ellipse", "size": [width, height] along the node's X and Y, "radiance": [red, green, blue]}. It lies in the
/// node's XY plane around its origin, turned and stretched by the node's transform, and shines along −Z; nothing is
/// seen of it, and it is in nothing's way. What lacks one of the three is another tool's, and goes to the losses.
/// Throws InputError for values that are wrong, and for a lamp that the transform leaves no area.
std::optional<AreaLight> area_lamp_of(const tinygltf::Node& node, const PlacedNode& placed, Losses& losses);

}  // namespace penumbra::scenes
