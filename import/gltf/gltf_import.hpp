// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/import.hpp"
#include "scenes/formats/reader.hpp"
#include "scenes/scene.hpp"

namespace penumbra::import {

/// Reads a glTF scene in the current process: called by the import helper under its limits; all other callers use
/// read_gltf. Throws InputError; std::bad_alloc.
scenes::Scene import_gltf(const mesh::InputFile& input, const scenes::ReadOptions& options);

/// Reads only the triangles of a glTF file, as one mesh. Scenes and mesh files share this reader. Surfaces whose alpha
/// lets light through would become solid: refused unless `options` are lenient.
mesh::ImportedMesh import_gltf_mesh(const mesh::InputFile& input, const scenes::ReadOptions& options);

/// Returns whether the file's name has an extension of glTF.
bool is_gltf(const std::filesystem::path& file);

}  // namespace penumbra::import
