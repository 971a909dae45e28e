// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/import.hpp"

#include <string>
#include <string_view>

namespace penumbra::import {

/// Reads X3D (ISO/IEC 19775, in the XML encoding) in double precision: every Shape that the scene graph shows, as often
/// as DEF and USE show it. Assimp reads the format, too, but drops repetitions by USE and the children of Collision and
/// other grouping nodes. Nodes that cannot be a surface are ignored and counted by name; surfaces and groupings of
/// unknown kinds are refused by name.
mesh::ImportedMesh read_x3d(std::string_view content, const std::string& file);

}  // namespace penumbra::import
