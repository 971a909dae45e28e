#pragma once

#include "scenes/scene.hpp"

#include <penumbra/scene.hpp>

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace penumbra {

/// A mesh as it was added or read: what set_transform() starts from.
struct RestMesh {
  std::uint32_t first = 0;  ///< of its vertices among the scene's; one after the other
  std::vector<glm::dvec3> positions;
  std::vector<glm::vec3> normals;  ///< empty: the scene has none
};

/// Which vertices a mesh was given.
struct GivenVertices {
  std::vector<std::uint32_t> used;  ///< numbers of those that the scene has, in order; empty: all
  std::size_t count = 0;            ///< of all
};

/// A number that no scene has had.
std::uint64_t next_meshes();

struct Scene::State {
  scenes::Scene scene;
  /// For each object, from its first set_transform() on.
  std::vector<std::optional<RestMesh>> rest = {};
  /// For each object, or the first of them: those after have all their vertices.
  std::vector<GivenVertices> given = {};
  /// The origin that the file gives, as of scenes that move: it stays, whatever is added.
  std::optional<glm::dvec3> file_origin = {};
  /// Another number, other triangles, pictures or vertices' looks: of all scenes of the process.
  std::uint64_t meshes = next_meshes();
  std::optional<std::size_t> camera = {};  ///< the one that looks by default; nullopt: the first
};

}  // namespace penumbra
