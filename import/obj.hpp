// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/import.hpp"

#include <string>
#include <string_view>

namespace penumbra::import {

/// Reads the surfaces of a Wavefront OBJ file in double precision; only `v` and `f` are required. Does not use Assimp,
/// whose reader turns faces into points where they name a texture coordinate or normal that does not exist, drops
/// vertices of an unusual length (and so renumbers later ones), and takes time quadratic in the number of groups.
///
/// Everything but surfaces is counted in the notes. Throws InputError with the line. `with_places`: fills
/// ImportedMesh::places, too, if faces name texture coordinates.
mesh::ImportedMesh read_obj_text(std::string_view text, const std::string& file, bool with_places = false);

}  // namespace penumbra::import
