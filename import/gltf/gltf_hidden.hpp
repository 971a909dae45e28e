#pragma once

#include <glm/mat4x4.hpp>

#include <optional>
#include <vector>

namespace tinygltf {
class Model;
class Node;
}  // namespace tinygltf

namespace penumbra::scenes {

/// Each node's scale as the file has it, before anything moves.
std::vector<std::vector<double>> rest_scales(const tinygltf::Model& model);

/// Where each node would be if none were scaled to nothing: a scale of 0 becomes that of `rest`, or 1 if that is 0 too.
/// By node number; nothing for those that are not in the scene. The model comes back as it was.
std::vector<std::optional<glm::dmat4>> unhidden_places(tinygltf::Model& model,
                                                       const std::vector<std::vector<double>>& rest);

/// Does this transform squash a mesh with an emissive material to a line or a point, of which `unhidden` would not? So
/// lamps are hidden in animations: they are keyed to a scale of 0.
bool hides_light(const tinygltf::Model& model, const tinygltf::Node& node, const glm::dmat4& to_world,
                 const glm::dmat4& unhidden);

}  // namespace penumbra::scenes
