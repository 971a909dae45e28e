#pragma once

#include "mesh/input_file.hpp"

namespace tinygltf {
class Model;
}

namespace penumbra::scenes {

/// Parses a .gltf or .glb file (told apart by its first bytes) with its buffers, but without its images. Buffers come
/// from the file's folder and below, or from anywhere if `allow_outside`. Throws InputError.
void load_gltf_model(const mesh::InputFile& input, bool allow_outside, tinygltf::Model& model);

/// Did Blender's exporter write it? It means some things in its own way.
bool is_from_blender(const tinygltf::Model& model);

}  // namespace penumbra::scenes
