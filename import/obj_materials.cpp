// SPDX-License-Identifier: Apache-2.0
// Finds the materials of an OBJ that let light through, in its material libraries (MTL).

#include "import/obj_materials.hpp"

#include "base/error.hpp"
#include "import/text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <vector>

namespace penumbra::import {
namespace {

/// Returns the text without blanks at its ends.
std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// Calls take(keyword, rest) for each line.
template <typename Take>
void for_each_statement(std::string_view text, const Take& take) {
  for (std::string_view line; take_line(text, line);) {
    const std::string_view keyword = take_word(line);
    if (!keyword.empty()) take(keyword, trimmed(line));
  }
}

/// Returns the content of a file in the folder or below. Empty if there is no such file, or if it is larger than any
/// material library or cannot be read: the mesh does not need it.
std::string content_of(const mesh::InputFile& input, std::string_view name) {
  constexpr off_t kMostBytes = 64 << 20;
  const mesh::OpenedBeneath file =
      mesh::open_beneath(input.folder.get(), std::string(name), O_RDONLY | O_NONBLOCK | O_NOCTTY);
  struct stat info {};
  if (file.error != 0 || ::fstat(file.descriptor.get(), &info) != 0) return {};
  if (!S_ISREG(info.st_mode) || info.st_size > kMostBytes) return {};
  try {
    return mesh::read_content(file.descriptor.get(), std::string(name));
  } catch (const InputError&) {
    return {};
  }
}

std::optional<double> number_in(std::string_view text) {
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() ? std::optional(value) : std::nullopt;
}

/// Returns names in quotes, the first of them if there are many.
std::string quoted(std::span<const std::string> names) {
  constexpr std::size_t kMost = 8;
  const std::size_t named = std::min(names.size(), kMost);
  return fmt::format("'{}'{}", fmt::join(names.first(named), "', '"), named < names.size() ? ", …" : "");
}

}  // namespace

std::optional<std::string> solid_materials_note(std::span<const std::string> materials) {
  if (materials.empty()) return std::nullopt;
  return fmt::format(
      "materials that let light through, which is not supported for this format: {}; their surfaces are taken as solid "
      "(glTF 2.0 keeps it)",
      quoted(materials));
}

std::optional<std::string> left_out_lamps_note(std::span<const std::string> lamps) {
  if (lamps.empty()) return std::nullopt;
  return fmt::format("lamps, which a mesh does not have: {}; left out (scenes of glTF 2.0, FBX and COLLADA keep them)",
                     quoted(lamps));
}

std::vector<std::string> transparent_materials(std::string_view obj, const mesh::InputFile& input) {
  std::set<std::string, std::less<>> used, open;
  std::vector<std::string> libraries;
  for_each_statement(obj, [&](std::string_view keyword, std::string_view rest) {
    if (keyword == "usemtl") used.emplace(rest);
    if (keyword == "mtllib" && std::ranges::find(libraries, rest) == libraries.end()) libraries.emplace_back(rest);
  });
  const auto read = [&](std::string_view text) {
    std::string material;
    for_each_statement(text, [&](std::string_view keyword, std::string_view rest) {
      if (keyword == "newmtl") material = rest;
      const bool lets_through = keyword == "map_d" || (keyword == "d" && number_in(rest).value_or(1) < 1) ||
                                (keyword == "Tr" && number_in(rest).value_or(0) > 0);
      if (lets_through && used.contains(material)) open.insert(material);
    });
  };
  for (const std::string& library : libraries) {  // one name with blanks, or several names
    const std::string whole = content_of(input, library);
    read(whole);
    std::string_view rest = library;
    for (std::string_view name; whole.empty() && !(name = take_word(rest)).empty();) read(content_of(input, name));
  }
  return {open.begin(), open.end()};
}

}  // namespace penumbra::import
