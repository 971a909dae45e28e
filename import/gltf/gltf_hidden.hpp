#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <span>
#include <vector>

namespace tinygltf {
class Model;
}  // namespace tinygltf

namespace penumbra::scenes {

/// Each node's scale as the file has it, before anything moves.
std::vector<std::vector<double>> rest_scales(const tinygltf::Model& model);

/// Where each node would be if none were scaled to nothing: a scale of 0 becomes that of `rest`, or 1 if that is 0 too.
/// By node number; nothing for those that are not in the scene. The model comes back as it was.
std::vector<std::optional<glm::dmat4>> unhidden_places(tinygltf::Model& model,
                                                       const std::vector<std::vector<double>>& rest);

/// Where each node is, by its number.
using Places = std::span<const std::optional<glm::dmat4>>;

/// Do these places, of the node or of its skin's joints, squash a mesh with an emissive material to a line or a point,
/// of which `unhidden` would not? So lamps are hidden in animations: they are keyed to a scale of 0. A point of what is
/// left of it, or nothing. Of a skinned mesh all must be squashed.
std::optional<glm::dvec3> hidden_light(const tinygltf::Model& model, int node, Places shown, Places unhidden);

}  // namespace penumbra::scenes
