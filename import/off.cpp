#include "import/off.hpp"

#include "import/faces.hpp"
#include "import/text.hpp"

#include <glm/vec3.hpp>

#include <array>

namespace penumbra::mesh {
namespace {

/// The file's words, line by line, without comments; knows the number of the current line for messages.
class OffWords {
 public:
  OffWords(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

  /// The next word on this line or a later one; fails at the end of the file.
  std::string_view next(std::string_view wanted) {
    for (;;) {
      if (const std::string_view word = next_on_line(); !word.empty()) return word;
      if (!next_line()) fail("the file ends where {} should follow; it is truncated", wanted);
    }
  }
  /// The next word on this line; empty at its end.
  std::string_view next_on_line() { return take_word(line_); }
  void skip_rest_of_line() { line_ = {}; }

  std::uint32_t count(std::string_view wanted) {
    const std::string_view word = next(wanted);
    const auto value = parse_number<std::uint32_t>(word);
    if (!value) fail("'{}' is no {}; expected an integer from 0 to 4294967295", word, wanted);
    return *value;
  }
  double real(std::string_view wanted) {
    const std::string_view word = next(wanted);
    const auto value = parse_number<double>(word);
    if (!value) fail("'{}' is no {}; expected a number", word, wanted);
    return *value;
  }
  [[nodiscard]] std::size_t bytes_left() const { return text_.size() + line_.size(); }

  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError("{}: line {}: {}", file_, line_number_, text_for_people(format, std::forward<Args>(args)...));
  }

 private:
  bool next_line() {
    if (!take_line(text_, line_)) return false;
    ++line_number_;
    line_ = line_.substr(0, line_.find('#'));
    return true;
  }
  std::string_view text_, line_;
  std::string file_;
  std::size_t line_number_ = 0;
};

struct OffHeader {
  bool homogeneous = false;  ///< 4OFF: a fourth coordinate divides the others
  std::uint32_t extras = 0;  ///< numbers after a vertex's coordinates that are always there: normal, texture
  bool colors = false;       ///< COFF: a colour of unknown length, up to the line's end
  std::uint32_t vertices = 0, faces = 0;
};

OffHeader read_header(OffWords& words) {
  OffHeader header;
  std::string_view word = words.next("the word OFF");
  const std::string_view whole = word;
  if (word.ends_with("OFF")) {  // [ST][C][N][4][n]OFF; the word may be missing altogether
    word.remove_suffix(3);
    if (word.starts_with("ST")) word.remove_prefix(2), header.extras += 2;
    if (word.starts_with('C')) word.remove_prefix(1), header.colors = true;
    if (word.starts_with('N')) word.remove_prefix(1), header.extras += 3;
    if (word.starts_with('4')) word.remove_prefix(1), header.homogeneous = true;
    if (!word.empty()) words.fail("'{}' files are not supported; expected OFF, COFF, NOFF, STOFF or 4OFF", whole);
    // "OFF BINARY": the counts would be binary, too.
    const std::string_view first = words.next("the number of vertices");
    if (first == "BINARY") words.fail("binary OFF is not supported; save it as ASCII OFF or PLY");
    const auto vertices = parse_number<std::uint32_t>(first);
    if (!vertices) words.fail("'{}' is no number of vertices", first);
    header.vertices = *vertices;
  } else {
    const auto vertices = parse_number<std::uint32_t>(word);
    if (!vertices) words.fail("'{}' is neither OFF nor a number of vertices; this is no OFF file", whole);
    header.vertices = *vertices;
  }
  header.faces = words.count("number of faces");
  words.skip_rest_of_line();  // the number of edges, which nobody uses and some leave out
  // A vertex takes at least "0 0 0 ", a face "0 ": a header that lies about that must not make us allocate.
  if (header.vertices * 6ull + header.faces * 2ull > words.bytes_left() + 1ull) {
    words.fail(
        "the header promises {} vertices and {} faces, more than the file's remaining {} bytes can hold; it is "
        "damaged or truncated",
        header.vertices, header.faces, words.bytes_left());
  }
  return header;
}

glm::dvec3 read_vertex(OffWords& words, const OffHeader& header, std::uint32_t number) {
  glm::dvec3 position;
  for (glm::length_t axis = 0; axis < 3; ++axis) position[axis] = words.real("coordinate");
  if (header.homogeneous) position /= words.real("coordinate");
  for (std::uint32_t i = 0; i < header.extras && !header.colors; ++i) words.real("vertex attribute");
  if (header.colors) words.skip_rest_of_line();
  if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z)) {
    words.fail("vertex {} is not finite: ({}, {}, {})", number, position.x, position.y, position.z);
  }
  return position;
}

}  // namespace

ImportedMesh read_off_text(std::string_view text, const std::string& file) {
  OffWords words(text, file);
  const OffHeader header = read_header(words);
  ImportedMesh mesh;
  mesh.soup.positions.reserve(header.vertices);
  for (std::uint32_t i = 0; i < header.vertices; ++i) mesh.soup.positions.push_back(read_vertex(words, header, i));
  FaceCollector faces(mesh.soup);
  std::vector<std::uint32_t> corners;
  for (std::uint32_t face = 0; face < header.faces; ++face) {
    corners.clear();
    const std::uint32_t count = words.count("number of corners");
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t index = words.count("vertex number");
      if (index >= header.vertices) {
        words.fail("face {} names vertex {}, but there are only {} (numbered from 0)", face, index, header.vertices);
      }
      corners.push_back(index);
    }
    words.skip_rest_of_line();  // the face's colour
    faces.add(corners);
  }
  if (mesh.soup.triangles.empty()) {
    throw InputError("{}: there are no triangles in it ({} vertices, {})", file, header.vertices,
                     faces.instead_of_surfaces());
  }
  mesh.notes = faces.notes();
  if (header.colors || header.extras > 0)
    mesh.notes.emplace_back("vertex colours, normals or texture coordinates ignored");
  return mesh;
}

}  // namespace penumbra::mesh
