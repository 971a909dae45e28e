#pragma once

#include "mesh/import.hpp"

#include <cstdint>
#include <string>

struct aiScene;

namespace penumbra::mesh {

struct AssimpSceneOptions {
  bool is_fbx = false;          ///< applies the file's unit and axes
  std::uint64_t triangles = 0;  ///< least number of triangles that the file shows, if it was counted: fewer are an
                                ///< error
};

/// Returns every mesh of the node tree, transformed by its nodes, in one soup.
ImportedMesh read_assimp_scene(const aiScene& scene, const std::string& file, const AssimpSceneOptions& options);

}  // namespace penumbra::mesh
