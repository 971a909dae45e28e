// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/import.hpp"

#include <string>
#include <string_view>

namespace penumbra::import {

/// Reads a 3MF package (core specification 1.3, and the paths of the production extension) in double precision: the
/// objects that its build lists, each at the places given by the build and by components. Does not use Assimp, whose
/// reader crashes on valid packages. Ignores units. Throws InputError with the entry and the line.
mesh::ImportedMesh read_3mf(std::string_view content, const std::string& file);

}  // namespace penumbra::import
