// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <vector>

namespace penumbra::app {

/// Input files of `inspect`.
struct InspectedFiles {
  std::vector<std::filesystem::path> files;
  bool several = false;  ///< more than one file, or a folder: a table in place of the long text, an array in JSON
};

/// Replaces each folder by the mesh files and scenes in this folder and in the folders below, in the order of their
/// names: files with an ending of a mesh format, and .json files that name the format of scenes. Hidden files and
/// folders are left out, and links to folders are not followed. Throws InputError for a folder that cannot be read or
/// contains no such file.
InspectedFiles inspected_files(std::span<const std::filesystem::path> named);

}  // namespace penumbra::app
