// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>

#include <optional>
#include <vector>

namespace tinygltf {
class Model;
class Node;
}  // namespace tinygltf

namespace penumbra::import {

/// EXT_mesh_gpu_instancing: returns the transforms from each instance of the node's mesh to the node. Returns nullopt
/// for a node without the extension; an empty list if the extension has no attributes, which means no instance at all.
/// Throws InputError, with the node's place, for lists that differ in length or have a wrong type.
std::optional<std::vector<glm::dmat4>> instances_of(const tinygltf::Model& model, const tinygltf::Node& node,
                                                    int number);

}  // namespace penumbra::import
