// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/descriptor.hpp"

#include <filesystem>
#include <string>

namespace penumbra::mesh {

/// A foreign file, opened once: later reads see the file that was opened, even if another file has its name by then.
struct InputFile {
  std::filesystem::path name;  ///< for messages and for its extension
  Descriptor content;          ///< of a regular file that is not empty
  Descriptor folder;           ///< files that the input refers to are looked for in this folder and below
};

/// Opens a file that the user names, following links. Throws InputError if the file is not a readable regular file, or
/// is empty; throw_file_error reports failures of the machine, here and below.
InputFile open_input(const std::filesystem::path& file);

/// Result of open_beneath.
struct OpenedBeneath {
  Descriptor descriptor;  ///< closed on failure
  std::string path;       ///< relative to the folder, with links resolved
  int error = 0;          ///< an errno; EXDEV if the name or a link leads out of the folder
};

/// Opens `name` in the folder or below, with open's `flags`. Links are followed while they stay below the folder: the
/// path is resolved component by component with a descriptor of each folder, so that no other process can replace a
/// folder by a link during the walk. Absolute names and links lead out, unless the folder is the root.
OpenedBeneath open_beneath(int folder, const std::string& name, int flags);

/// Opens `name` in the folder `folder` or below by open_beneath, with the checks of open_input. `shown` is the name in
/// messages. `error` and `path` are those of OpenedBeneath; a file that could be opened but fails a check gives an
/// InputError.
struct InputBeneath {
  InputFile input;
  std::string path;
  int error = 0;
};
InputBeneath open_input_beneath(int folder, const std::string& name, const std::filesystem::path& shown);

/// Returns all bytes of a file. Throws InputError if they cannot be read.
std::string read_content(int descriptor, const std::string& shown);

/// Throws InputError unless `descriptor` is that of a regular file; returns false if the file is empty.
bool require_regular(int descriptor, const std::string& shown);

}  // namespace penumbra::mesh
