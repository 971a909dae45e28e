// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

/// Files that the import helper has opened, so that the program knows the files that it must never overwrite. The
/// helper is a process for one job: the list is global.
namespace penumbra::mesh {

/// Call before reading each file, with its path.
void note_opened_file(std::string path);

/// Returns all noted files, each once, sorted by name.
std::vector<std::string> opened_files();

}  // namespace penumbra::mesh
