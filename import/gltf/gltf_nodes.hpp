// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>

#include <string>
#include <vector>

namespace tinygltf {
class Model;
}

namespace penumbra::import {

struct PlacedNode {
  int number;  ///< index into the model's nodes
  glm::dmat4 to_world;
  bool visible = true;  ///< KHR_node_visibility: if false, the node and the nodes below it are invisible
};

/// A transform in parts, as stored in glTF: three, four (x y z w) and three numbers, or none.
struct TransformParts {
  std::vector<double> translation, rotation, scale;
};

/// Returns the transform that scales, rotates and translates, in this order. `place` is that of the parts, for
/// messages. A rotation need not be of unit length. Throws InputError for a rotation of length 0, and for parts with a
/// wrong number of values or values that are not finite.
glm::dmat4 transform_of(const TransformParts& parts, const std::string& place);

/// Returns the nodes of the default scene, parents before children, each with its transform in double precision.
/// Without a default scene the first scene is used, without scenes all nodes that have no parent; a warning reports
/// this. The last row of a matrix may be 0 0 0 1 within single precision.
/// Throws InputError for a node that does not exist, has two parents or has an invalid transform.
std::vector<PlacedNode> place_nodes(const tinygltf::Model& model, std::vector<std::string>& warnings);

}  // namespace penumbra::import
