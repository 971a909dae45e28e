// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "import/scene_parts.hpp"
#include "mesh/import.hpp"
#include "mesh/input_file.hpp"

namespace penumbra::import {

/// Reads a mesh file (all formats but glTF, which the reader of scenes handles) in the current process: called by the
/// import helper under its limits. No other code may call it, because hostile files crash, hang and exhaust the
/// libraries behind it. Throws InputError; std::bad_alloc. `with_places`: fills ImportedMesh::places for OBJ files.
mesh::ImportedMesh read_mesh(const mesh::InputFile& input, bool with_places = false);

/// Reads a file that Assimp reads, as a whole scene: the mesh, and the lights and cameras in the file.
mesh::ImportedMesh read_scene_parts(const mesh::InputFile& input, SceneParts& parts);

}  // namespace penumbra::import
