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
  bool visible = true;  ///< KHR_node_visibility: nothing of the node is seen, or of those below it, where it is false
};

/// A transform in parts, as glTF has them: three, four (x y z w) and three numbers, or none.
struct TransformParts {
  std::vector<double> translation, rotation, scale;
};

/// Scaled, turned, moved. `place` is that of the parts, for messages. A rotation need not be of unit length; throws
/// InputError for one of length 0, and for parts that are not of so many finite numbers.
glm::dmat4 transform_of(const TransformParts& parts, const std::string& place);

/// The nodes of the default scene, parents before children, each with its transform in double precision. Without a
/// default scene the first one counts, without scenes all nodes that are nobody's child; `warnings` says so. The last
/// row of a matrix may be 0 0 0 1 within single precision.
/// Throws InputError for a node that does not exist, has two parents or a transform that is none.
std::vector<PlacedNode> place_nodes(const tinygltf::Model& model, std::vector<std::string>& warnings);

}  // namespace penumbra::scenes
