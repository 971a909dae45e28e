// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/import.hpp"

#include <string>
#include <string_view>

namespace penumbra::import {

/// Reads an STL file, ASCII or binary. Does not use Assimp, whose reader refuses binary files with bytes after their
/// last triangle or with a header that begins with "solid", and ASCII files with keywords in capitals.
///
/// Throws InputError: a binary file shorter than its count promises; in an ASCII file, with the line, facets without an
/// end, coordinates that are not numbers or not finite.
mesh::ImportedMesh read_stl(std::string_view content, const std::string& file);

}  // namespace penumbra::import
