// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/import.hpp"

#include <string>
#include <string_view>

namespace penumbra::import {

/// Reads a Geomview OFF file (ASCII: OFF, COFF, NOFF, STOFF, 4OFF and their combinations) in double precision. Does not
/// use Assimp, whose reader turns an index out of range into the last vertex, drops faces with more than nine corners,
/// leaves missing vertices at the origin, and requires a line for each vertex.
///
/// `file` is a name for messages.
mesh::ImportedMesh read_off_text(std::string_view text, const std::string& file);

}  // namespace penumbra::import
