// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/import.hpp"
#include "scenes/formats/reader.hpp"
#include "scenes/instances.hpp"
#include "scenes/scene.hpp"

#include <filesystem>
#include <functional>
#include <span>

namespace penumbra::import {

/// Receives a scene and its instances (if ReadOptions::instances is given); returns whether another one is wanted.
using TakeScene = std::function<bool(scenes::Scene, scenes::Instances)>;
/// Reads a glTF scene in the current process: called by the import helper under its limits; all other callers use
/// read_gltf. The file is parsed once, and the scene at `options.time` is given to `take`, then that at each of the
/// times `further`, while `take` wants more. For a scene without animations, or at rest, only the first scene is given.
/// Throws InputError; std::bad_alloc.
void import_gltf_scenes(const mesh::InputFile& input, const scenes::ReadOptions& options,
                        std::span<const double> further, const TakeScene& take);

/// Reads only the triangles of a glTF file, as one mesh. Scenes and mesh files share this reader. Surfaces whose alpha
/// lets light through would become solid: they are refused unless `options` are lenient.
mesh::ImportedMesh import_gltf_mesh(const mesh::InputFile& input, const scenes::ReadOptions& options);

/// Returns whether the file's name has an extension of glTF.
bool is_gltf(const std::filesystem::path& file);

}  // namespace penumbra::import
