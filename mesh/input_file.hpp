#pragma once

#include "base/descriptor.hpp"

#include <filesystem>
#include <string>

namespace penumbra::mesh {

/// A foreign file, opened once: what is read later is what was opened, whatever its name means by then.
struct InputFile {
  std::filesystem::path name;  ///< for messages and for its extension
  Descriptor content;          ///< of a regular file that is not empty
  Descriptor folder;           ///< what the file names beside itself is looked for there and below
};

/// Opens what the user names, following links. InputError if it is not a readable regular file, or empty;
/// what the machine lacks, throw_file_error says, here and below.
InputFile open_input(const std::filesystem::path& file);

/// What came of open_beneath.
struct OpenedBeneath {
  Descriptor descriptor;  ///< closed on failure
  std::string path;       ///< from the folder, with links resolved
  int error = 0;          ///< an errno; EXDEV if the name or a link on the way leads out of the folder
};

/// Opens `name` in the folder or below, with open's `flags`. Links are followed while they stay below the folder: the
/// way is walked name by name with a descriptor of each folder, so that nobody can exchange one for a link meanwhile.
/// Absolute names and links lead out, unless the folder is the root.
OpenedBeneath open_beneath(int folder, const std::string& name, int flags);

/// As open_input, for a `name` in the folder `folder` or below, by open_beneath. `shown` is its name in messages. The
/// error is OpenedBeneath's; InputError as with open_input where it could be opened.
struct InputBeneath {
  InputFile input;
  std::string path;
  int error = 0;
};
InputBeneath open_input_beneath(int folder, const std::string& name, const std::filesystem::path& shown);

/// All of a file's bytes. InputError if they cannot be read.
std::string read_content(int descriptor, const std::string& shown);

/// Throws InputError unless `descriptor` is that of a regular file; false if it is empty.
bool require_regular(int descriptor, const std::string& shown);

}  // namespace penumbra::mesh
