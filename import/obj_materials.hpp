// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/input_file.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::import {

/// Returns a note that names materials whose transparency is not read: their surfaces are taken as solid. Returns
/// nullopt if there are no materials.
std::optional<std::string> solid_materials_note(std::span<const std::string> materials);

/// Returns a note that names the lamps of a file of which only the mesh is read; nullopt if there are no lamps.
std::optional<std::string> left_out_lamps_note(std::span<const std::string> lamps);

/// Returns the materials of an OBJ's faces that let light through: those named by `usemtl` that have d below 1, Tr
/// above 0 or map_d in a material library (MTL). Reads the libraries that `mtllib` names in the file's folder and
/// below; missing ones are skipped.
std::vector<std::string> transparent_materials(std::string_view obj, const mesh::InputFile& input);

}  // namespace penumbra::import
