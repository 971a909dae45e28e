#pragma once

#include <string>
#include <vector>

/// What the import helper has opened, so that the program knows all files that it must never write to. The helper is a
/// process for one job: the list is the process's.
namespace penumbra::mesh {

/// Call it for each file that is about to be read, by its path.
void note_opened_file(std::string path);

/// All of them, each once, in the order of their names.
std::vector<std::string> opened_files();

}  // namespace penumbra::mesh
