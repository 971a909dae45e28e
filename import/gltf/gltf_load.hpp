// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "import/gltf/gltf_mend.hpp"
#include "mesh/input_file.hpp"
#include "scenes/formats/reader.hpp"

namespace tinygltf {
class Model;
}

namespace penumbra::import {

/// Parses a .gltf or .glb file (told apart by its first bytes) with its buffers; images are not decoded. Buffers come
/// from the file's folder and below, or from anywhere if `options.allow_outside`. Returns the parts that were removed
/// so that the file could be parsed. Throws InputError; no message contains a data URI's content.
TakenOut load_gltf_model(const mesh::InputFile& input, const scenes::ReadOptions& options, tinygltf::Model& model);

}  // namespace penumbra::import
