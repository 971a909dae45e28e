#pragma once

#include "mesh/import.hpp"

#include <string>
#include <string_view>

namespace penumbra::mesh {

/// Reads a 3MF package (core specification 1.3, and of the production extension the paths) in double precision: what
/// its build lists, every object where the build and components put it. Not through Assimp, because its reader crashes
/// on valid packages. Units are not looked at. Throws InputError with the entry and the line.
ImportedMesh read_3mf(std::string_view content, const std::string& file);

}  // namespace penumbra::mesh
