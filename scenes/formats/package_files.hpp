// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/input_file.hpp"

#include <filesystem>
#include <string_view>

namespace penumbra::scenes {

/// Folder in which Debian's package manager keeps the list of each package's files.
inline constexpr const char* kDpkgInfo = "/var/lib/dpkg/info";

/// Opens the file of an installed Debian package whose path ends with "/" and `file`. Links may lead only to another
/// file of that package. Throws InputError as find_package_file does.
mesh::InputFile open_package_file(std::string_view package, std::string_view file,
                                  const std::filesystem::path& dpkg_info = kDpkgInfo);

/// Returns the path of the file of an installed Debian package that ends with "/" and `file`; reads only the package
/// manager's lists. Throws InputError if the package is not installed (with the command to install it), has no such
/// file, or several.
std::filesystem::path find_package_file(std::string_view package, std::string_view file,
                                        const std::filesystem::path& dpkg_info = kDpkgInfo);

}  // namespace penumbra::scenes
