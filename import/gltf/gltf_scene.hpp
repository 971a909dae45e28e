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

namespace penumbra::scenes {

/// What a file is read for; `rest`: a mesh as it is modelled, which no skin and no morph target bends.
enum class Purpose : std::uint8_t { lit_scene, any_scene, mesh, rest };

struct SceneRequest {
  const std::string& name;  ///< the scene's
  const ReadOptions& options;
  std::span<const std::optional<glm::dmat4>> unhidden = {};  ///< see unhidden_places; empty: nothing moves
  std::span<const std::size_t> played = {};                  ///< numbers of the animations that move it
};

struct BuiltScene {
  Scene scene;
  bool left_vertices_out = false;  ///< some of the file's vertices are not in the scene
};

/// The scene of a parsed model, as its nodes stand now; `taken_out`: what parsing left out. Throws InputError for a
/// file that is damaged, and for what is refused.
BuiltScene build_scene(const tinygltf::Model& model, const SceneRequest& request, Purpose purpose,
                       const TakenOut& taken_out);

/// The middle of all vertices of the model's meshes, seen or not, as they are modelled.
glm::dvec3 middle_at_rest(const tinygltf::Model& model, const SceneRequest& request);

}  // namespace penumbra::scenes
