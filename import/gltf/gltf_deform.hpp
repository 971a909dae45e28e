// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
class Node;
struct Primitive;
}  // namespace tinygltf

namespace penumbra::import {

/// Adds a primitive's morph targets to its vertices (glTF 2.0, 3.7.2.2), each by its weight: the node's, or else the
/// mesh's, or else 0. `attribute` is the attribute's name ("POSITION"). Throws InputError for targets that do not fit.
void morph(const tinygltf::Model& model, const tinygltf::Node& node, const tinygltf::Primitive& primitive,
           const std::string& attribute, const std::string& place, std::span<glm::dvec3> vertices);

/// A skinned primitive.
struct Skinned {
  std::vector<glm::dmat4> vertices;  ///< for each vertex, the transform from its modelled position into the world
  std::size_t without_weights = 0;   ///< number of vertices that no joint moves
};

/// A node with a mesh, and its place in the world.
struct MeshNode {
  const tinygltf::Node& node;
  const glm::dmat4& to_world;
};

/// Returns for each vertex of a skinned primitive: Σ weight · joint · inverse bind matrix (glTF 2.0, 3.7.3.3), its
/// weights divided by their sum, so that rounded weights move nothing. The node's own transform moves only vertices
/// without weights, as Blender intends; its exporters before 3.2 wrote such vertices. Returns nullopt for a node
/// without a skin or a primitive without joints. `to_world` has each node's transform by its index, nullopt for nodes
/// outside of the scene. Throws InputError for joints that do not exist.
std::optional<Skinned> skin(const tinygltf::Model& model, const MeshNode& owner, const tinygltf::Primitive& primitive,
                            const std::string& place, std::span<const std::optional<glm::dmat4>> to_world);

}  // namespace penumbra::import
