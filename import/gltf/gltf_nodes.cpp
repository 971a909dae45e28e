#include "import/gltf/gltf_nodes.hpp"

#include "base/error.hpp"

#include <tiny_gltf.h>

#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra::scenes {
namespace {

/// A property of `wanted` finite numbers, or none at all.
bool has_numbers(const std::vector<double>& numbers, std::size_t wanted, int node, const char* property) {
  if (numbers.empty()) return false;
  if (numbers.size() != wanted) {
    throw InputError("/nodes/{}/{}: {} numbers; expected {}", node, property, numbers.size(), wanted);
  }
  if (!std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); })) {
    throw InputError("/nodes/{}/{}: a number is not finite", node, property);
  }
  return true;
}

glm::dmat4 local_transform(const tinygltf::Node& node, int number) {
  glm::dmat4 transform(1);
  if (has_numbers(node.matrix, 16, number, "matrix")) {
    for (glm::length_t i = 0; i < 16; ++i) transform[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
    if (transform[0][3] != 0 || transform[1][3] != 0 || transform[2][3] != 0 || transform[3][3] != 1) {
      throw InputError("/nodes/{}/matrix: its last row must be 0 0 0 1", number);
    }
    return transform;
  }
  if (has_numbers(node.translation, 3, number, "translation")) {
    transform = glm::translate(transform, {node.translation[0], node.translation[1], node.translation[2]});
  }
  if (has_numbers(node.rotation, 4, number, "rotation")) {  // glTF: x y z w; glm's constructor: w x y z
    const glm::dquat rotation(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    if (!(glm::length(rotation) > 0)) throw InputError("/nodes/{}/rotation: a quaternion of length 0", number);
    transform *= glm::mat4_cast(glm::normalize(rotation));
  }
  if (has_numbers(node.scale, 3, number, "scale")) {
    transform = glm::scale(transform, {node.scale[0], node.scale[1], node.scale[2]});
  }
  return transform;
}

std::vector<int> root_nodes(const tinygltf::Model& model, std::vector<std::string>& warnings) {
  const auto scenes = model.scenes.size();
  if (model.defaultScene >= 0 && static_cast<std::size_t>(model.defaultScene) >= scenes) {
    throw InputError("/scene: scene {} does not exist; there are {}", model.defaultScene, scenes);
  }
  const std::size_t chosen = model.defaultScene >= 0 ? static_cast<std::size_t>(model.defaultScene) : 0;
  if (scenes > 1) {
    warnings.push_back(fmt::format("{} of {} scenes ignored; '{}' (number {}) is rendered", scenes - 1, scenes,
                                   model.scenes[chosen].name, chosen));
  }
  if (scenes > 0) return model.scenes[chosen].nodes;

  warnings.emplace_back("there is no scene in the file; all its nodes are rendered");
  std::vector<bool> is_child(model.nodes.size(), false);
  for (const tinygltf::Node& node : model.nodes) {
    for (const int child : node.children) {
      if (child >= 0 && static_cast<std::size_t>(child) < is_child.size())
        is_child[static_cast<std::size_t>(child)] = true;
    }
  }
  std::vector<int> roots;
  for (std::size_t i = 0; i < is_child.size(); ++i) {
    if (!is_child[i]) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

}  // namespace

std::vector<PlacedNode> place_nodes(const tinygltf::Model& model, std::vector<std::string>& warnings) {
  std::vector<PlacedNode> placed;
  std::vector<PlacedNode> stack;
  const std::vector<int> roots = root_nodes(model, warnings);
  for (std::size_t i = roots.size(); i-- > 0;) stack.push_back({roots[i], glm::dmat4(1)});
  std::vector<bool> visited(model.nodes.size(), false);
  while (!stack.empty()) {  // no recursion: a file may nest a million nodes
    PlacedNode node = stack.back();
    stack.pop_back();
    if (node.number < 0 || static_cast<std::size_t>(node.number) >= model.nodes.size()) {
      throw InputError("/nodes/{}: it does not exist; there are {}", node.number, model.nodes.size());
    }
    const auto index = static_cast<std::size_t>(node.number);
    // A tree reaches each node once; this also ends every cycle.
    if (visited[index]) throw InputError("/nodes/{}: it has two parents or is its own ancestor", node.number);
    visited[index] = true;
    node.to_world = node.to_world * local_transform(model.nodes[index], node.number);  // the stack held the parent's
    const auto& children = model.nodes[index].children;
    for (std::size_t i = children.size(); i-- > 0;) stack.push_back({children[i], node.to_world});
    placed.push_back(node);
  }
  return placed;
}

}  // namespace penumbra::scenes
