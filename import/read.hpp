#pragma once

#include "mesh/import.hpp"
#include "mesh/input_file.hpp"

namespace penumbra::mesh {

/// Reads a mesh file (all but glTF, which the scenes' reader does) in this very process: what the import helper does
/// under its limits. Nobody else should call it, because hostile files crash, hang and exhaust the libraries behind it.
/// Throws InputError; std::bad_alloc.
/// `with_places`: ImportedMesh::places, of OBJ files.
ImportedMesh read_mesh(const InputFile& input, bool with_places = false);

}  // namespace penumbra::mesh
