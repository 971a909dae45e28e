// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/input_file.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::import {

/// Returns a note that names materials whose transparency is not read: their surfaces are taken as solid. nullopt:
/// there are none.
std::optional<std::string> solid_materials_note(std::span<const std::string> materials);

/// Returns a note that names lamps of a file of which the mesh alone is read. nullopt: there are none.
std::optional<std::string> left_out_lamps_note(std::span<const std::string> lamps);

/// Returns the materials of an OBJ's faces that let light through: those that `usemtl` names and that have, in a
/// library (MTL) that `mtllib` names in the file's folder or below, d below 1, Tr above 0 or map_d. A library that is
/// not there is passed over.
std::vector<std::string> transparent_materials(std::string_view obj, const mesh::InputFile& input);

}  // namespace penumbra::import
