#pragma once

#include "mesh/import.hpp"
#include "scenes/formats/reader.hpp"
#include "scenes/scene.hpp"

namespace penumbra::scenes {

/// Reads a glTF scene in this very process: what the import helper does under its limits; everybody else calls
/// read_gltf. Throws InputError; std::bad_alloc.
Scene import_gltf(const mesh::InputFile& input, const ReadOptions& options);

/// Reads only the triangles of a glTF file, as one mesh. Scenes and mesh files share this reader. Surfaces with an
/// alpha that lets light through would be solid: refused unless `options` are lenient.
mesh::ImportedMesh import_gltf_mesh(const mesh::InputFile& input, const ReadOptions& options);

/// Whether the file's name says that it is glTF.
bool is_gltf(const std::filesystem::path& file);

}  // namespace penumbra::scenes
