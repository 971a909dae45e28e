// SPDX-License-Identifier: Apache-2.0
// Parses the header of a PLY file and checks, before any memory is allocated, that the file is long enough for the
// elements that the header announces.

#include "import/ply_header.hpp"

#include "base/error.hpp"
#include "import/text.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace penumbra::import {
namespace {

std::optional<PlyType> type_named(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, PlyType>, 18> kTypes = {{{"char", PlyType::int8},
                                                                            {"int8", PlyType::int8},
                                                                            {"uchar", PlyType::uint8},
                                                                            {"uint8", PlyType::uint8},
                                                                            {"short", PlyType::int16},
                                                                            {"int16", PlyType::int16},
                                                                            {"ushort", PlyType::uint16},
                                                                            {"uint16", PlyType::uint16},
                                                                            {"int", PlyType::int32},
                                                                            {"int32", PlyType::int32},
                                                                            {"uint", PlyType::uint32},
                                                                            {"uint32", PlyType::uint32},
                                                                            {"int64", PlyType::int64},
                                                                            {"uint64", PlyType::uint64},
                                                                            {"float", PlyType::float32},
                                                                            {"float32", PlyType::float32},
                                                                            {"double", PlyType::float64},
                                                                            {"float64", PlyType::float64}}};
  const auto* found = std::ranges::find(kTypes, name, &std::pair<std::string_view, PlyType>::first);
  return found == kTypes.end() ? std::nullopt : std::optional(found->second);
}

class HeaderReader {
 public:
  explicit HeaderReader(const std::string& file) : file_(file) {}

  PlyHeader read(std::string_view content) {
    constexpr std::size_t kMostLines = 10000;
    header_.body = content;
    bool ended = false;
    std::string_view line;
    bool ends_are_returns = false;  // the first line ends with a lone carriage return, and so do all lines
    while (!ended && header_.lines < kMostLines && take_line(header_.body, line)) {
      ++header_.lines;
      const std::string_view end(line.end(), header_.body.begin());
      if (header_.lines == 1) ends_are_returns = end == "\r";
      // A line feed after such a return is not part of the line's end: it is a binary body's first byte.
      if (ends_are_returns && end == "\r\n")
        header_.body = std::string_view(header_.body.begin() - 1, header_.body.end());
      std::string_view rest = line;
      const std::string_view keyword = take_word(rest);
      if (header_.lines == 1 && keyword != "ply" && keyword != "PLY")
        fail("this is no PLY file: it does not begin with 'ply'");
      if (keyword == "format") format(take_word(rest));
      if (keyword == "element") element(rest);
      if (keyword == "property") property(rest);
      ended = keyword == "end_header";
    }
    if (!ended) throw InputError("{}: PLY header: there is no end_header; the file is truncated or no PLY file", file_);
    if (!has_format_) fail("there is no format");
    require_room();
    return std::move(header_);
  }

 private:
  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError("{}: PLY header: line {}: {}", file_, header_.lines,
                     text_for_people(format, std::forward<Args>(args)...));
  }

  void format(std::string_view word) {
    has_format_ = true;
    if (word == "ascii")
      header_.format = PlyFormat::ascii;
    else if (word == "binary_little_endian")
      header_.format = PlyFormat::little_endian;
    else if (word == "binary_big_endian")
      header_.format = PlyFormat::big_endian;
    else
      fail("'{}' is no format; expected ascii, binary_little_endian or binary_big_endian", word);
  }

  void element(std::string_view rest) {
    PlyElement element;
    element.name = take_word(rest);
    const std::string_view count = take_word(rest);
    const auto value = parse_number<std::uint64_t>(count);
    if (!value) fail("'{}' is no number of elements '{}'", count, element.name);
    element.count = *value;
    header_.elements.push_back(std::move(element));
  }

  PlyType type(std::string_view word) const {
    const auto type = type_named(word);
    if (!type) fail("unknown type '{}'", word);
    return *type;
  }

  void property(std::string_view rest) {
    if (header_.elements.empty()) fail("a property before any element");
    PlyProperty property;
    std::string_view word = take_word(rest);
    if (word == "list") {
      property.is_list = true;
      property.length_type = type(take_word(rest));
      if (property.length_type == PlyType::float32 || property.length_type == PlyType::float64) {
        fail("a list whose length is no integer");
      }
      word = take_word(rest);
    }
    property.type = type(word);
    property.name = take_word(rest);
    header_.elements.back().properties.push_back(std::move(property));
  }

  /// Checks that the file is large enough for its elements, before memory is allocated.
  void require_room() const {
    std::uint64_t left = header_.body.size() + 1;  // the last line may lack its end
    for (const PlyElement& element : header_.elements) {
      std::uint64_t bytes = 0;  // least bytes of one element: for a list, its length field
      for (const PlyProperty& property : element.properties) {
        const std::size_t binary = size_of(property.is_list ? property.length_type : property.type);
        bytes += header_.format == PlyFormat::ascii ? 2 : binary;
      }
      bytes = std::max<std::uint64_t>(bytes, 1);  // empty elements count as one byte: a billion cannot be intended
      if (element.count > left / bytes) {
        throw InputError(
            "{}: PLY header: it promises {} elements '{}' of {} bytes or more, but only {} bytes follow; the file is "
            "truncated or damaged",
            file_, element.count, mesh::printable(element.name), bytes, left);
      }
      left -= element.count * bytes;
    }
  }

  const std::string& file_;
  PlyHeader header_;
  bool has_format_ = false;
};

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int64:
    case PlyType::uint64:
    case PlyType::float64:
      return 8;
    default:
      return 4;
  }
}

PlyHeader read_ply_header(std::string_view content, const std::string& file) {
  return HeaderReader(file).read(content);
}

}  // namespace penumbra::import
