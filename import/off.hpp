#pragma once

#include "mesh/import.hpp"

#include <string>
#include <string_view>

namespace penumbra::mesh {

/// Reads a Geomview OFF file (ASCII: OFF, COFF, NOFF, STOFF, 4OFF and their combinations) in double precision. Not
/// through Assimp, because its reader turns an index that is out of range into the last vertex, drops faces with more
/// than nine corners, leaves missing vertices at the origin, and wants each vertex on a line of its own.
///
/// `file` is a name for messages.
ImportedMesh read_off_text(std::string_view text, const std::string& file);

}  // namespace penumbra::mesh
