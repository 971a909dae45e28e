#include "mesh/import_audit.hpp"

#include "mesh/import_text.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>

namespace penumbra::mesh {
namespace {

// ------------------------------------------------------------------------------------------------------------- OBJ

/// Checks an OBJ file's statements one by one.
class ObjAudit {
 public:
  ObjAudit(std::string text, std::string file) : text_(std::move(text)), file_(std::move(file)) {}

  FileAudit run() {
    std::string_view rest = text_;
    if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);  // byte order mark
    std::string_view line;
    std::string joined;  // of lines that end in a backslash
    while (take_line(rest, line)) {
      ++line_number_;
      if (joined.empty()) begins_face_ = is_face(line);
      if (begins_face_) blank_comment(line);
      if (line.ends_with('\\')) {
        joined.append(line.substr(0, line.size() - 1)).append(" ");
        continue;
      }
      if (joined.empty()) {
        statement(line);
      } else {
        statement(joined.append(line));
        joined.clear();
      }
    }
    if (!joined.empty()) statement(joined);
    if (highest_index_ > vertices_) {
      throw InputError("{}: line {}: the face names vertex {}, but there are only {} (numbered from 1)", file_,
                       highest_line_, highest_index_, vertices_);
    }
    FileAudit audit{surfaces_, {}, std::nullopt};
    if (blanked_) audit.text = std::move(text_);
    if (free_form_ > 0)
      audit.notes.push_back(fmt::format("{} free-form statements (curves, surfaces) skipped", free_form_));
    return audit;
  }

 private:
  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError("{}: line {}: {}", file_, line_number_, fmt::format(format, std::forward<Args>(args)...));
  }

  static bool is_face(std::string_view line) {
    const std::string_view keyword = take_word(line);
    return keyword == "f" || keyword == "l" || keyword == "p";
  }

  /// Assimp takes a comment after a face for more of its corners.
  void blank_comment(std::string_view line) {
    const std::size_t start = line.find('#');
    if (start == std::string_view::npos) return;
    const auto first = text_.begin() + (line.data() - text_.data()) + static_cast<std::ptrdiff_t>(start);
    std::fill_n(first, line.size() - start, ' ');
    blanked_ = true;
  }

  void statement(std::string_view line) {
    line = line.substr(0, line.find('#'));
    const std::string_view keyword = take_word(line);
    if (keyword == "v") vertex(line);
    if (keyword == "f" || keyword == "fo") face(line);
    if (keyword == "curv" || keyword == "curv2" || keyword == "surf") ++free_form_;
  }

  void vertex(std::string_view line) {
    ++vertices_;
    std::array<double, 8> numbers{};
    std::size_t count = 0;
    for (std::string_view word; !(word = take_word(line)).empty(); ++count) {
      if (count == numbers.size()) fail("vertex {} has too many numbers", vertices_);
      const auto number = parse_number<double>(word);
      if (!number) fail("vertex {}: '{}' is not a number", vertices_, word);
      // Its positions are single precision from here on, so what overflows that is infinite as well.
      if (!std::isfinite(static_cast<float>(*number))) fail("vertex {} is not finite: '{}'", vertices_, word);
      numbers[count] = *number;
    }
    // x y z, x y z w, or x y z r g b: Assimp drops a vertex with any other count, and so renumbers all after it.
    if (count != 3 && count != 4 && count != 6) fail("vertex {} has {} numbers; expected 3, 4 or 6", vertices_, count);
    if (count == 4 && numbers[3] == 0) fail("vertex {} has the weight 0, so it lies at infinity", vertices_);
  }

  void face(std::string_view line) {
    std::uint64_t corners = 0;
    for (std::string_view word; !(word = take_word(line)).empty(); ++corners) {
      const std::string_view position = word.substr(0, word.find('/'));
      const auto index = parse_number<std::int64_t>(position);
      if (!index) fail("'{}' is not a vertex number", word);
      if (*index == 0) fail("vertex numbers start at 1, but the face names vertex 0");
      if (*index < 0 && static_cast<std::uint64_t>(-*index) > vertices_) {
        fail("the face names vertex {} from the end, but only {} come before it", *index, vertices_);
      }
      // A positive number may name a vertex that only follows: it is judged at the end.
      if (*index > 0 && static_cast<std::uint64_t>(*index) > highest_index_) {
        highest_index_ = static_cast<std::uint64_t>(*index);
        highest_line_ = line_number_;
      }
    }
    if (corners >= 3) ++surfaces_;
  }

  std::string text_, file_;
  bool begins_face_ = false, blanked_ = false;
  std::size_t line_number_ = 0, highest_line_ = 0;
  std::uint64_t vertices_ = 0, surfaces_ = 0, free_form_ = 0, highest_index_ = 0;
};

// ------------------------------------------------------------------------------------------------------------- PLY

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

/// Reads the header, and compares what it promises with the bytes that follow it.
FileAudit audit_ply(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::vector<PlyElement> elements;
  std::string line;
  bool ascii = false, ended = false, strips = false;
  const auto fail = [&](const std::string& what) { throw InputError("{}: PLY header: {}", file.string(), what); };
  constexpr int kMostLines = 10000;
  for (int number = 1; number <= kMostLines && !ended && std::getline(stream, line); ++number) {
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

  const auto header = static_cast<std::uint64_t>(stream.tellg());
  std::uint64_t left = std::filesystem::file_size(file) - header + 1;  // the last line may lack its end
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
  FileAudit audit;
  const auto faces = std::ranges::find(elements, "face", &PlyElement::name);
  if (faces != elements.end() && !strips) audit.surfaces = faces->count;
  return audit;
}

// ------------------------------------------------------------------------------------------------------------- STL

/// A binary STL file is 80 bytes of anything (which may start with "solid", as ASCII ones do), a count, and 50 bytes a
/// triangle. A file that starts otherwise can only be binary, and then its length must fit.
FileAudit audit_stl(const std::filesystem::path& file) {
  constexpr std::uint64_t kHeader = 84, kTriangle = 50;
  const std::uint64_t size = std::filesystem::file_size(file);
  std::array<char, kHeader> header{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(header.data(), kHeader);
  std::string_view start(header.data(), static_cast<std::size_t>(stream.gcount()));
  const bool says_solid = take_word(start).starts_with("solid");
  if (size >= kHeader) {
    std::uint32_t count = 0;
    std::memcpy(&count, header.data() + 80, sizeof(count));
    const std::uint64_t wanted = kHeader + kTriangle * count;
    if (size == wanted) return {count, {}, std::nullopt};
    if (!says_solid && size < wanted) {
      throw InputError("{}: a binary STL file of {} triangles takes {} bytes, but it has {}; it is truncated",
                       file.string(), count, wanted, size);
    }
    if (!says_solid)
      return {count, {fmt::format("{} bytes after the last triangle ignored", size - wanted)}, std::nullopt};
  }
  if (!says_solid) throw InputError("{}: neither ASCII STL ('solid …') nor long enough for binary STL", file.string());

  const std::string text = read_whole_file(file);
  std::uint64_t facets = 0, ended = 0;
  std::string_view rest = text, line;
  for (std::size_t number = 1; take_line(rest, line); ++number) {
    const std::string_view keyword = take_word(line);
    if (keyword == "facet") ++facets;
    if (keyword == "endfacet") ++ended;
    if (keyword != "vertex") continue;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = take_word(line);
      const auto value = parse_number<double>(word);
      if (!value) throw InputError("{}: line {}: '{}' is not a coordinate", file.string(), number, word);
      if (!std::isfinite(static_cast<float>(*value))) {
        throw InputError("{}: line {}: a vertex is not finite: '{}'", file.string(), number, word);
      }
    }
  }
  if (facets != ended) {
    throw InputError("{}: {} facets begin but {} end; the file is truncated", file.string(), facets, ended);
  }
  return {facets, {}, std::nullopt};
}

}  // namespace

FileAudit audit_mesh_file(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  if (extension == ".obj") return ObjAudit(read_whole_file(file), file.string()).run();
  if (extension == ".ply") return audit_ply(file);
  if (extension == ".stl") return audit_stl(file);
  return {};
}

}  // namespace penumbra::mesh
