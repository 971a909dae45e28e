#include "mesh/import_audit.hpp"

#include "mesh/import_text.hpp"

#include <algorithm>
#include <vector>

namespace penumbra::mesh {
namespace {

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::uint64_t bytes = 0;  ///< the least that one takes: in binary the sum of its numbers, in ASCII two a property
};

std::uint64_t size_of_ply_type(std::string_view type) {
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
  if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
  if (type == "int" || type == "uint" || type == "float" || type == "int32" || type == "uint32" || type == "float32")
    return 4;
  if (type == "double" || type == "float64") return 8;
  return 0;
}

}  // namespace

std::optional<std::uint64_t> audit_ply(std::string_view content, const std::string& file) {
  std::string_view rest_of_file = content, line;
  std::vector<PlyElement> elements;
  bool ascii = false, ended = false, strips = false;
  const auto fail = [&](const std::string& what) { throw InputError("{}: PLY header: {}", file, what); };
  constexpr int kMostLines = 10000;
  for (int number = 1; number <= kMostLines && !ended && take_line(rest_of_file, line); ++number) {
    std::string_view rest = line;
    const std::string_view keyword = take_word(rest);
    if (number == 1 && keyword != "ply" && keyword != "PLY") fail("line 1 is not 'ply'; this is no PLY file");
    if (keyword == "format") ascii = take_word(rest) == "ascii";
    if (keyword == "element") {
      PlyElement element{std::string(take_word(rest)), 0, 0};
      const bool named = !element.name.empty() && (element.name[0] < '0' || element.name[0] > '9');
      if (!named) {  // Assimp would take the digits for the count, and loop
        fail(fmt::format("line {}: '{}' is no name of an element", number, element.name));
      }
      const std::string_view count = take_word(rest);
      const auto value = parse_number<std::uint64_t>(count);
      if (!value) fail(fmt::format("line {}: '{}' is no number of elements", number, count));
      element.count = *value;
      strips = strips || element.name == "tristrips";
      elements.push_back(std::move(element));
    }
    if (keyword == "property") {
      if (elements.empty()) fail(fmt::format("line {}: a property before any element", number));
      std::string_view type = take_word(rest);
      if (type == "list") type = take_word(rest);  // of a list, at least the length is there
      const std::uint64_t bytes = size_of_ply_type(type);
      if (bytes == 0) fail(fmt::format("line {}: unknown type '{}'", number, type));
      elements.back().bytes += ascii ? 2 : bytes;
    }
    ended = keyword == "end_header";
  }
  if (!ended) fail("there is no end_header; the file is truncated or no PLY file");

  std::uint64_t left = rest_of_file.size() + 1;  // the last line may lack its end
  for (const PlyElement& element : elements) {
    // One without properties takes a byte, too: nobody means to repeat nothing a billion times.
    if (element.count > left / std::max<std::uint64_t>(element.bytes, 1)) {
      fail(
          fmt::format("it promises {} elements '{}' of {} bytes or more, but only {} bytes follow; the file is "
                      "truncated or damaged",
                      element.count, element.name, std::max<std::uint64_t>(element.bytes, 1), left));
    }
    left -= element.count * element.bytes;
  }
  const auto faces = std::ranges::find(elements, "face", &PlyElement::name);
  if (faces == elements.end() || strips) return std::nullopt;
  return faces->count;
}

}  // namespace penumbra::mesh
