#pragma once

#include "mesh/import.hpp"

#include <string>
#include <string_view>

namespace penumbra::mesh {

/// Reads the surfaces of a Wavefront OBJ file in double precision: `v` and `f` are all that is needed. Not through
/// Assimp, because its reader turns faces into points where they name a texture coordinate or normal that does not
/// exist, drops vertices of an unusual length (and so renumbers those that follow), and takes time that grows with the
/// square of the number of groups.
///
/// What is not a surface is counted in the notes. Throws InputError with the line.
/// `with_places`: ImportedMesh::places too, where faces name texture coordinates.
ImportedMesh read_obj_text(std::string_view text, const std::string& file, bool with_places = false);

}  // namespace penumbra::mesh
