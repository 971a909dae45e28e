// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "import/scene_parts.hpp"
#include "mesh/import.hpp"

#include <cstdint>
#include <string>

struct aiScene;

namespace penumbra::import {

struct AssimpSceneOptions {
  bool is_fbx = false;          ///< applies the unit and axes of an FBX file
  std::uint64_t triangles = 0;  ///< least number of triangles, if counted: a file with fewer is rejected
  SceneParts* parts = nullptr;  ///< receives everything except triangles
};

/// Returns every mesh of the node tree, transformed by its nodes, in one soup.
mesh::ImportedMesh read_assimp_scene(const aiScene& scene, const std::string& file, const AssimpSceneOptions& options);

}  // namespace penumbra::import
