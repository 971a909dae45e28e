#pragma once

#include "mesh/input_file.hpp"

#include <filesystem>
#include <string_view>

namespace penumbra::scenes {

/// Where Debian's package manager keeps the list of each package's files.
inline constexpr const char* kDpkgInfo = "/var/lib/dpkg/info";

/// Opens the file of an installed Debian package whose path ends with "/" and `file`. Where links on the way lead
/// elsewhere, only to another file of that package. InputError as find_package_file.
mesh::InputFile open_package_file(std::string_view package, std::string_view file,
                                  const std::filesystem::path& dpkg_info = kDpkgInfo);

/// The path of the file of an installed Debian package whose path ends with "/" and `file`; only reads the package
/// manager's lists. InputError if the package is not installed (and how to install it), has no such file, or several.
std::filesystem::path find_package_file(std::string_view package, std::string_view file,
                                        const std::filesystem::path& dpkg_info = kDpkgInfo);

}  // namespace penumbra::scenes
