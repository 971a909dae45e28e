#pragma once

#include <glm/mat4x4.hpp>

#include <string>
#include <vector>

namespace tinygltf {
class Model;
}

namespace penumbra::scenes {

struct PlacedNode {
  int number;  ///< index into the model's nodes
  glm::dmat4 to_world;
};

/// The nodes of the default scene, parents before children, each with its transform in double precision. Without a
/// default scene the first one counts, without scenes all nodes that are nobody's child; `warnings` says so.
/// Throws InputError for a node that does not exist, has two parents or a transform that is none.
std::vector<PlacedNode> place_nodes(const tinygltf::Model& model, std::vector<std::string>& warnings);

}  // namespace penumbra::scenes
