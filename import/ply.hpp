#pragma once

#include "mesh/import.hpp"

#include <string>
#include <string_view>

namespace penumbra::mesh {

/// Reads the surfaces of a PLY file, ASCII or binary of either endianness, in double precision: positions, and the
/// lists of vertices of faces and triangle strips. Not through Assimp, because its reader allocates what a list says
/// before it looks, and reads past the end of a file that is too short for it.
///
/// Whatever else is in the file is skipped and noted. Throws InputError with the line, or in binary the element's
/// number.
ImportedMesh read_ply(std::string_view content, const std::string& file);

/// The same of a binary body, number by number, whatever it holds: what read_ply, which takes what is usual many
/// numbers at once, is tested against.
ImportedMesh read_ply_slowly(std::string_view content, const std::string& file);

}  // namespace penumbra::mesh
