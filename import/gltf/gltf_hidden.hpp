// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <span>
#include <vector>

namespace tinygltf {
class Model;
}  // namespace tinygltf

namespace penumbra::import {

/// Returns each node's scale as stored in the file, before any animation.
std::vector<std::vector<double>> rest_scales(const tinygltf::Model& model);

/// Returns each node's transform as if no node were scaled to zero: a scale of 0 becomes that of `rest`, or 1 if that
/// is 0, too. By node index; nullopt for nodes outside of the scene. The model is unchanged on return.
std::vector<std::optional<glm::dmat4>> unhidden_places(tinygltf::Model& model,
                                                       const std::vector<std::vector<double>>& rest);

/// Each node's transform, by its index.
using Places = std::span<const std::optional<glm::dmat4>>;

/// If the transforms `shown` of the node (or of its skin's joints) squash a mesh with an emissive material to a line or
/// a point, and the transforms `unhidden` would not, returns a point of the squashed mesh; else nullopt. Animations
/// hide lamps by keying their scale to 0. All joints of a skinned mesh must be squashed.
std::optional<glm::dvec3> hidden_light(const tinygltf::Model& model, int node, Places shown, Places unhidden);

}  // namespace penumbra::import
