#pragma once

#include <filesystem>
#include <span>
#include <vector>

namespace penumbra::app {

/// The files that `inspect` looks at.
struct InspectedFiles {
  std::vector<std::filesystem::path> files;
  bool several = false;  ///< more than one, or a folder was named: a table in place of the long text, an array in JSON
};

/// Replaces each folder by the mesh files and scenes in it and in the folders below it, in the order of their names:
/// files with an ending of a mesh format, and .json files that name the format of scenes. Hidden files and folders are
/// left out, and links to folders are not followed. Throws InputError for a folder that cannot be read or holds no such
/// file.
InspectedFiles inspected_files(std::span<const std::filesystem::path> named);

}  // namespace penumbra::app
