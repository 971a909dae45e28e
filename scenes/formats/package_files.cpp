// SPDX-License-Identifier: Apache-2.0
// Finds a file of a Debian package in the lists that dpkg keeps. A link must lead to a file of the same package.

#include "scenes/formats/package_files.hpp"

#include "base/file_error.hpp"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <set>
#include <string>
#include <system_error>
#include <vector>

namespace penumbra::scenes {
namespace {

/// Returns whether the name is valid by Debian policy 5.6.1, which also keeps slashes out of the path formed from it.
bool is_package_name(std::string_view name) {
  const auto is_lower_or_digit = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); };
  return name.size() >= 2 && is_lower_or_digit(name[0]) && std::all_of(name.begin(), name.end(), [&](char c) {
           return is_lower_or_digit(c) || c == '+' || c == '-' || c == '.';
         });
}

/// Returns <package>.list, or <package>:<architecture>.list for packages that may be installed for several
/// architectures.
std::vector<std::filesystem::path> package_lists(std::string_view package, const std::filesystem::path& dpkg_info) {
  std::vector<std::filesystem::path> lists;
  const std::string prefix = std::string(package) + ":";
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(dpkg_info, error)) {
    const std::filesystem::path& path = entry.path();
    if (path.extension() != ".list") continue;
    const std::string stem = path.stem().string();
    if (stem == package || stem.starts_with(prefix)) lists.push_back(path);
  }
  if (error && error.value() != ENOENT) throw_file_error(error.value(), dpkg_info.string());
  std::sort(lists.begin(), lists.end());
  return lists;
}

/// Returns all paths in the lists.
std::set<std::string> listed_files(const std::vector<std::filesystem::path>& lists) {
  std::set<std::string> files;
  for (const std::filesystem::path& list : lists) {
    std::ifstream lines(list);
    if (!lines) throw_file_error(errno, list.string());
    for (std::string line; std::getline(lines, line);) files.insert(line);
  }
  return files;
}

/// Returns whether the lists contain the path. Packages may list files of /usr/lib under /lib, because the system links
/// /lib to /usr/lib.
bool is_listed(const std::set<std::string>& files, const std::string& path) {
  constexpr std::string_view kUsr = "/usr";
  return files.contains(path) || (path.starts_with("/usr/") && files.contains(path.substr(kUsr.size())));
}

}  // namespace

mesh::InputFile open_package_file(std::string_view package, std::string_view file,
                                  const std::filesystem::path& dpkg_info) {
  const std::filesystem::path path = find_package_file(package, file, dpkg_info);
  const Descriptor root(::open("/", O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (!root.is_open()) throw_file_error(errno, "/");
  mesh::InputBeneath opened = mesh::open_input_beneath(root.get(), path.string(), path);
  if (opened.error != 0) {
    throw_file_error(opened.error, fmt::format("{}, which the package \"{}\" lists", path.string(), package));
  }
  if (!is_listed(listed_files(package_lists(package, dpkg_info)), "/" + opened.path)) {
    throw InputError("{}: a link leads to /{}, which is no file of the package \"{}\"", path.string(), opened.path,
                     package);
  }
  return std::move(opened.input);
}

std::filesystem::path find_package_file(std::string_view package, std::string_view file,
                                        const std::filesystem::path& dpkg_info) {
  if (!is_package_name(package)) {
    throw InputError("\"{}\" is not the name of a Debian package; expected lower-case letters, digits, +, - and .",
                     package);
  }
  const std::vector<std::filesystem::path> lists = package_lists(package, dpkg_info);
  if (lists.empty()) {
    throw InputError("the Debian package \"{0}\" is not installed; install it with: apt-get install {0}", package);
  }
  const std::string ending = "/" + std::string(file);
  std::vector<std::string> found;
  for (const std::string& line : listed_files(lists)) {
    if (line.ends_with(ending)) found.push_back(line);
  }
  if (found.empty()) {
    throw InputError("the package \"{0}\" has no file that ends with \"{1}\"; see: dpkg -L {0}", package, ending);
  }
  if (found.size() > 1) {
    throw InputError("the package \"{}\" has several files that end with \"{}\" ({}, {}); give more of the path",
                     package, ending, found[0], found[1]);
  }
  return found[0];
}

}  // namespace penumbra::scenes
