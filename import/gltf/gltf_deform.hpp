#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

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

/// For each vertex of a skinned primitive what takes it from where it was modelled into the world: Σ weight · joint ·
/// inverse bind matrix (glTF 2.0, 3.7.3.3), its weights divided by their sum, so that rounded ones move nothing. The
/// node's own transform plays no part. Nothing for a node without a skin or a primitive without joints.
/// `to_world` holds each node's transform by its number, nothing for those that are not in the scene.
/// InputError for joints that do not exist, or a vertex without weights.
std::optional<std::vector<glm::dmat4>> skin(const tinygltf::Model& model, const tinygltf::Node& node,
                                            const tinygltf::Primitive& primitive, const std::string& place,
                                            std::span<const std::optional<glm::dmat4>> to_world);

}  // namespace penumbra::scenes
