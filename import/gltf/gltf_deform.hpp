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

namespace penumbra::scenes {

/// Adds a primitive's morph targets to its vertices (glTF 2.0, 3.7.2.2), each by its weight: the node's, or else the
/// mesh's, or else 0. `attribute` says of what ("POSITION"). InputError for targets that do not fit.
void morph(const tinygltf::Model& model, const tinygltf::Node& node, const tinygltf::Primitive& primitive,
           const std::string& attribute, const std::string& place, std::span<glm::dvec3> vertices);

/// A skinned primitive.
struct Skinned {
  std::vector<glm::dmat4> vertices;  ///< what takes each from where it was modelled into the world
  std::size_t without_weights = 0;   ///< vertices that no joint moves
};

/// A node with a mesh, and where it is in the world.
struct MeshNode {
  const tinygltf::Node& node;
  const glm::dmat4& to_world;
};

/// For each vertex of a skinned primitive: Σ weight · joint · inverse bind matrix (glTF 2.0, 3.7.3.3), its weights
/// divided by their sum, so that rounded ones move nothing. The node's own transform moves only vertices without
/// weights, as Blender means them, whose exporters before 3.2 wrote such. Nothing for a node without a skin or a
/// primitive without joints. `to_world` holds each node's transform by its number, nothing for those that are not in
/// the scene. InputError for joints that do not exist.
std::optional<Skinned> skin(const tinygltf::Model& model, const MeshNode& owner, const tinygltf::Primitive& primitive,
                            const std::string& place, std::span<const std::optional<glm::dmat4>> to_world);

}  // namespace penumbra::scenes
