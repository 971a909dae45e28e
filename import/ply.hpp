// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/import.hpp"

#include <string>
#include <string_view>

namespace penumbra::import {

/// Reads the surfaces of a PLY file, ASCII or binary of either endianness, in double precision: positions, and the
/// vertex lists of faces and triangle strips. Does not use Assimp, whose reader allocates the size of a list before
/// checking it, and reads past the end of a file that is too short.
///
/// Everything else in the file is skipped and noted. Throws InputError with the line, or in binary files the element's
/// number.
mesh::ImportedMesh read_ply(std::string_view content, const std::string& file);

/// Gives the same result as read_ply, but reads every binary body number by number: a reference for tests of read_ply,
/// which reads usual layouts in bulk.
mesh::ImportedMesh read_ply_slowly(std::string_view content, const std::string& file);

}  // namespace penumbra::import
