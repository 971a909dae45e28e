// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/import.hpp"

#include <string>
#include <string_view>

namespace penumbra::import {

/// Reads an STL file, ASCII or binary. Does not use Assimp, whose reader refuses binary files with bytes after their
/// last triangle or with a header that begins with "solid", and ASCII files with keywords in capitals.
///
/// Throws InputError for a binary file that is shorter than its count promises; and, with the line, for an ASCII file
/// with facets without an end, or with coordinates that are not numbers or not finite.
mesh::ImportedMesh read_stl(std::string_view content, const std::string& file);

}  // namespace penumbra::import
