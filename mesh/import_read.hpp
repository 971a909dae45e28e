#pragma once

#include "mesh/import.hpp"

#include <filesystem>

namespace penumbra::mesh {

/// Reads a mesh file in this very process: what the import helper does under its limits. Nobody else should call it,
/// because hostile files crash, hang and exhaust the libraries behind it. Throws InputError; std::bad_alloc.
ImportedMesh read_mesh_file(const std::filesystem::path& file);

}  // namespace penumbra::mesh
