// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "import/gltf/gltf_mend.hpp"
#include "scenes/formats/reader.hpp"
#include "scenes/scene.hpp"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace tinygltf {
class Model;
}

namespace penumbra::import {

/// Purpose of reading a file; `rest`: a mesh as modelled, without skins and morph targets.
enum class Purpose : std::uint8_t { lit_scene, any_scene, mesh, rest };

struct SceneRequest {
  const std::string& name;  ///< the scene's name
  const scenes::ReadOptions& options;
  std::span<const std::optional<glm::dmat4>> unhidden = {};  ///< see unhidden_places; empty if nothing moves
  std::span<const std::size_t> played = {};                  ///< indices of the animations that move the scene
};

struct BuiltScene {
  scenes::Scene scene;
  bool left_vertices_out = false;  ///< some of the file's vertices are not in the scene
};

/// Builds the scene of a parsed model with the current places of its nodes; `taken_out`: the parts that parsing left
/// out. Throws InputError for a file that is damaged or refused.
BuiltScene build_scene(const tinygltf::Model& model, const SceneRequest& request, Purpose purpose,
                       const TakenOut& taken_out);

/// Returns the centre of the bounds of all vertices of the model's meshes, visible or not, as modelled.
glm::dvec3 middle_at_rest(const tinygltf::Model& model, const SceneRequest& request);

}  // namespace penumbra::import
