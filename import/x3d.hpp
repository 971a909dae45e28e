#pragma once

#include "mesh/import.hpp"

#include <string>
#include <string_view>

namespace penumbra::mesh {

/// Reads X3D (ISO/IEC 19775, in the encoding as XML) in double precision: every Shape that the scene graph shows, as
/// often as DEF and USE show it. Assimp reads the format, too, but drops what USE repeats and what Collision and other
/// grouping nodes hold. Nodes that cannot be a surface are ignored and counted by name; a surface or a grouping of a
/// kind that is not known here is refused by name.
ImportedMesh read_x3d(std::string_view content, const std::string& file);

}  // namespace penumbra::mesh
