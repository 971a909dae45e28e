#pragma once

#include "import/scene_parts.hpp"
#include "mesh/import.hpp"

#include <cstdint>
#include <string>

struct aiScene;

namespace penumbra::mesh {

struct AssimpSceneOptions {
  bool is_fbx = false;          ///< its unit and axes are applied
  std::uint64_t triangles = 0;  ///< so many at least the file shows, where it was counted: fewer are refused
  SceneParts* parts = nullptr;  ///< gets what there is beside triangles
};

/// Returns every mesh of the node tree, transformed by its nodes, in one soup.
ImportedMesh read_assimp_scene(const aiScene& scene, const std::string& file, const AssimpSceneOptions& options);

}  // namespace penumbra::mesh
