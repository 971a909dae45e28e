// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/input_file.hpp"
#include "scenes/formats/reader.hpp"
#include "scenes/scene.hpp"

#include <filesystem>

namespace penumbra::import {

/// Returns whether Assimp reads the file as a scene: FBX and COLLADA.
bool is_foreign_scene(const std::filesystem::path& file);

/// Reads a scene: its meshes where its nodes place them, one object each, with the diffuse colour of its material and
/// its normals; emissive meshes as lights, as for glTF (gltf/emitters/); point, spot and directional lamps; cameras.
/// Lamps have no size in these files: sizes come from ReadOptions. Throws InputError and std::bad_alloc.
scenes::Scene import_foreign_scene(const mesh::InputFile& input, const scenes::ReadOptions& options);

}  // namespace penumbra::import
