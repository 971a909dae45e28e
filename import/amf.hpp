#pragma once

#include "mesh/import.hpp"

#include <string>
#include <string_view>

namespace penumbra::mesh {

/// Reads an AMF file (ISO/ASTM 52915, version 1.2), as XML or zipped, in double precision. Not through Assimp, because
/// its reader leaves out all volumes of an object but one and takes degrees for radians.
///
/// Every object appears where the constellations put it, or as it is if none names it. Curved triangles (with normals
/// or edges) are read as flat, and units are not looked at. Throws InputError with the line.
ImportedMesh read_amf(std::string_view content, const std::string& file);

}  // namespace penumbra::mesh
