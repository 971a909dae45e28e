// SPDX-License-Identifier: Apache-2.0
// Morph targets and skins of glTF 2.0: sections 3.7.2.2 and 3.7.3.

#include "import/gltf/gltf_deform.hpp"

#include "base/error.hpp"
#include "import/gltf/gltf_accessor.hpp"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace penumbra::import {
namespace {

std::vector<double> weights_of(const tinygltf::Model& model, const tinygltf::Node& node) {
  if (!node.weights.empty()) return node.weights;
  return model.meshes[static_cast<std::size_t>(node.mesh)].weights;  // the mesh's index was checked before
}

/// Returns for each joint its transform from the bind pose into the world.
std::vector<glm::dmat4> joint_matrices(const tinygltf::Model& model, int number,
                                       std::span<const std::optional<glm::dmat4>> to_world) {
  const std::string place = fmt::format("/skins/{}", number);
  const tinygltf::Skin& source = model.skins[static_cast<std::size_t>(number)];
  if (source.joints.empty()) throw InputError("{}/joints: there are none", place);
  std::optional<Numbers> inverse;
  if (source.inverseBindMatrices >= 0) {
    inverse =
        read_numbers(model, source.inverseBindMatrices, {TINYGLTF_TYPE_MAT4}, "inverse bind matrices", NotFinite::keep);
    if (inverse->count() < source.joints.size()) {
      throw InputError("{}/inverseBindMatrices: {} matrices for {} joints", place, inverse->count(),
                       source.joints.size());
    }
  }
  std::vector<glm::dmat4> matrices;
  for (std::size_t j = 0; j < source.joints.size(); ++j) {
    const int joint = source.joints[j];
    if (joint < 0 || static_cast<std::size_t>(joint) >= to_world.size() || !to_world[static_cast<std::size_t>(joint)])
      throw InputError("{}/joints/{}: node {} is not in the scene", place, j, joint);
    glm::dmat4 bind(1);
    for (glm::length_t i = 0; inverse && i < 16; ++i)
      bind[i / 4][i % 4] = inverse->values[16 * j + static_cast<std::size_t>(i)];
    matrices.push_back(*to_world[static_cast<std::size_t>(joint)] * bind);
  }
  return matrices;
}

}  // namespace

void morph(const tinygltf::Model& model, const tinygltf::Node& node, const tinygltf::Primitive& primitive,
           const std::string& attribute, const std::string& place, std::span<glm::dvec3> vertices) {
  if (primitive.targets.empty() || vertices.empty()) return;  // targets may have normals that the mesh lacks
  const std::vector<double> weights = weights_of(model, node);
  for (std::size_t t = 0; t < std::min(weights.size(), primitive.targets.size()); ++t) {
    const auto target = primitive.targets[t].find(attribute);
    if (weights[t] == 0 || target == primitive.targets[t].end()) continue;
    const std::vector<glm::dvec3> moves = read_positions(model, target->second);
    if (moves.size() != vertices.size()) {
      throw InputError("{}/targets/{}: it moves {} vertices of {}", place, t, moves.size(), vertices.size());
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] += weights[t] * moves[i];
  }
}

std::optional<Skinned> skin(const tinygltf::Model& model, const MeshNode& owner, const tinygltf::Primitive& primitive,
                            const std::string& place, std::span<const std::optional<glm::dmat4>> to_world) {
  const tinygltf::Node& node = owner.node;
  if (node.skin >= 0 && static_cast<std::size_t>(node.skin) >= model.skins.size())
    throw InputError("/skins/{}: it does not exist; there are {}", node.skin, model.skins.size());
  if (node.skin < 0 || !primitive.attributes.contains("JOINTS_0")) return std::nullopt;
  const std::vector<glm::dmat4> joints = joint_matrices(model, node.skin, to_world);
  Skinned skinned;
  std::vector<glm::dmat4>& vertices = skinned.vertices;
  std::vector<double> sums;
  for (int set = 0;; ++set) {
    const auto number = primitive.attributes.find(fmt::format("JOINTS_{}", set));
    if (number == primitive.attributes.end()) break;
    const auto share = primitive.attributes.find(fmt::format("WEIGHTS_{}", set));
    if (share == primitive.attributes.end())
      throw InputError("{}/attributes: JOINTS_{} without WEIGHTS_{}", place, set, set);
    const Numbers numbers = read_numbers(model, number->second, {TINYGLTF_TYPE_VEC4}, "joints");
    const Numbers weights = read_numbers(model, share->second, {TINYGLTF_TYPE_VEC4}, "weights", NotFinite::keep);
    if (set == 0) {
      vertices.assign(numbers.count(), glm::dmat4(0));
      sums.assign(numbers.count(), 0);
    }
    if (numbers.count() != vertices.size() || weights.count() != vertices.size()) {
      throw InputError("{}/attributes: {} joints and {} weights in set {} for {} vertices", place, numbers.count(),
                       weights.count(), set, vertices.size());
    }
    for (std::size_t i = 0; i < numbers.values.size(); ++i) {
      if (weights.values[i] == 0 || !std::isfinite(weights.values[i])) continue;
      const double joint = numbers.values[i];
      if (!(joint >= 0 && joint < static_cast<double>(joints.size())))
        throw InputError("{}/attributes/JOINTS_{}: joint {} of {}", place, set, joint, joints.size());
      vertices[i / 4] += weights.values[i] * joints[static_cast<std::size_t>(joint)];
      sums[i / 4] += weights.values[i];
    }
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (sums[i] > 0) {
      vertices[i] /= sums[i];
    } else {
      vertices[i] = owner.to_world;
      ++skinned.without_weights;
    }
  }
  return skinned;
}

}  // namespace penumbra::import
