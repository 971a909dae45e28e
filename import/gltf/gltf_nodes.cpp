// SPDX-License-Identifier: Apache-2.0
// Transforms of all nodes to the world, without recursion. A node that is reached twice (two parents, a cycle) is
// refused; a node's matrix overrules its translation, rotation and scale.

#include "import/gltf/gltf_nodes.hpp"

#include "base/error.hpp"

#include <tiny_gltf.h>

#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra::import {
namespace {

/// Returns whether a property exists; throws unless it has `wanted` finite numbers or none.
bool has_numbers(const std::vector<double>& numbers, std::size_t wanted, const std::string& place) {
  if (numbers.empty()) return false;
  if (numbers.size() != wanted) throw InputError("{}: {} numbers; expected {}", place, numbers.size(), wanted);
  if (!std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); }))
    throw InputError("{}: a number is not finite", place);
  return true;
}

/// Checks the last row of a matrix that exporters multiplied in single precision: a product of a few matrices is off by
/// some units in the last place.
bool is_affine(const glm::dmat4& transform) {
  constexpr double kRounding = 16 * static_cast<double>(std::numeric_limits<float>::epsilon());
  const auto near = [](double x, double wanted) { return std::abs(x - wanted) <= kRounding; };
  return near(transform[0][3], 0) && near(transform[1][3], 0) && near(transform[2][3], 0) && near(transform[3][3], 1);
}

glm::dmat4 local_transform(const tinygltf::Node& node, int number) {
  const std::string place = fmt::format("/nodes/{}", number);
  if (!has_numbers(node.matrix, 16, place + "/matrix"))
    return transform_of({node.translation, node.rotation, node.scale}, place);
  glm::dmat4 transform(1);
  for (glm::length_t i = 0; i < 16; ++i) transform[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
  if (!is_affine(transform)) throw InputError("{}/matrix: its last row must be 0 0 0 1", place);
  transform[0][3] = transform[1][3] = transform[2][3] = 0;
  transform[3][3] = 1;
  return transform;
}

bool is_visible(const tinygltf::Node& node) {
  const auto extension = node.extensions.find("KHR_node_visibility");
  if (extension == node.extensions.end() || !extension->second.Has("visible")) return true;
  const tinygltf::Value& visible = extension->second.Get("visible");
  return !visible.IsBool() || visible.Get<bool>();
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

glm::dmat4 transform_of(const TransformParts& parts, const std::string& place) {
  glm::dmat4 transform(1);
  const auto& [translation, rotation, scale] = parts;
  if (has_numbers(translation, 3, place + "/translation"))
    transform = glm::translate(transform, {translation[0], translation[1], translation[2]});
  if (has_numbers(rotation, 4, place + "/rotation")) {  // glTF: x y z w; glm's constructor: w x y z
    const glm::dquat turn(rotation[3], rotation[0], rotation[1], rotation[2]);
    if (!(glm::length(turn) > 0)) throw InputError("{}/rotation: a quaternion of length 0", place);
    transform *= glm::mat4_cast(glm::normalize(turn));
  }
  if (has_numbers(scale, 3, place + "/scale")) transform = glm::scale(transform, {scale[0], scale[1], scale[2]});
  return transform;
}

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
    // A tree reaches each node once; this check also ends every cycle.
    if (visited[index]) throw InputError("/nodes/{}: it has two parents or is its own ancestor", node.number);
    visited[index] = true;
    // The fields `to_world` and `visible` were those of the parent up to here.
    node.to_world = node.to_world * local_transform(model.nodes[index], node.number);
    node.visible = node.visible && is_visible(model.nodes[index]);
    const auto& children = model.nodes[index].children;
    for (std::size_t i = children.size(); i-- > 0;) stack.push_back({children[i], node.to_world, node.visible});
    placed.push_back(node);
  }
  const auto is_something = [](const tinygltf::Node& node) {
    return node.mesh >= 0 || node.camera >= 0 || node.extensions.contains("KHR_lights_punctual");
  };
  std::size_t left = 0;
  for (std::size_t i = 0; model.scenes.size() == 1 && i < visited.size(); ++i)
    left += !visited[i] && is_something(model.nodes[i]) ? 1 : 0;
  if (left > 0) warnings.push_back(fmt::format("{} nodes with meshes, lamps or cameras are in no scene", left));
  return placed;
}

}  // namespace penumbra::import
