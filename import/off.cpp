// SPDX-License-Identifier: Apache-2.0
// Reads Geomview OFF files in double precision.

#include "import/off.hpp"

#include "import/faces.hpp"
#include "import/text.hpp"

#include <glm/vec3.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace penumbra::import {
namespace {

/// The file's words, line by line, without comments, with the number of the current line for messages.
class OffWords {
 public:
  OffWords(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

  /// Returns the next word on this line or a later one; throws at the end of the file.
  std::string_view next(std::string_view wanted) {
    for (;;) {
      if (const std::string_view word = next_on_line(); !word.empty()) return word;
      if (!next_line()) fail("the file ends where {} should follow; it is truncated", wanted);
    }
  }
  /// Returns the next word on this line; empty at its end.
  std::string_view next_on_line() { return take_word(line_); }
  void skip_rest_of_line() { line_ = {}; }
  bool next_line() {
    if (!take_line(text_, line_)) return false;
    ++line_number_;
    line_ = without_comment(line_);
    return true;
  }

  std::uint32_t count(std::string_view wanted) {
    const std::string_view word = next(wanted);
    const auto value = parse_number<std::uint32_t>(word);
    if (!value) fail("'{}' is no {}; expected an integer from 0 to 4294967295", word, wanted);
    return *value;
  }
  double real(std::string_view wanted) {
    const std::string_view word = next(wanted);
    const auto value = parse_real(word);
    if (!value) fail("'{}' is no {}; expected a number", word, wanted);
    return *value;
  }
  [[nodiscard]] std::size_t bytes_left() const { return text_.size() + line_.size(); }
  [[nodiscard]] std::size_t line_number() const { return line_number_; }

  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError("{}: line {}: {}", file_, line_number_, text_for_people(format, std::forward<Args>(args)...));
  }

 private:
  std::string_view text_, line_;
  std::string file_;
  std::size_t line_number_ = 0;
};

struct OffHeader {
  bool homogeneous = false;  ///< 4OFF: a fourth coordinate divides the others
  bool attributes = false;   ///< the header promises normals, colours or texture coordinates
  std::uint32_t extras = 0;  ///< numbers that follow every vertex's coordinates: normal, texture
  bool colors = false;       ///< COFF: a colour with an unknown number of components
  std::uint32_t vertices = 0, faces = 0;
};

/// Reads the letters before OFF: ST, C, N, 4 and n, in Geomview's order or in that of MeshLab, which writes NCOFF.
void read_letters(std::string_view letters, OffHeader& header, OffWords& words) {
  const std::string_view all = letters;
  bool any_dimension = false;
  while (!letters.empty()) {
    const std::size_t length = letters.starts_with("ST") ? 2 : 1;
    switch (letters.front()) {
      case 'S':
        header.extras += 2;
        break;
      case 'C':
        header.colors = true;
        break;
      case 'N':
        header.extras += 3;
        break;
      case '4':
        header.homogeneous = true;
        break;
      case 'n':
        any_dimension = true;
        break;
      default:
        break;
    }
    if (std::string_view("SCN4n").find(letters.front()) == std::string_view::npos ||
        (letters.front() == 'S' && length == 1)) {
      words.fail("'{}OFF' files are not supported; expected OFF with any of the letters ST, C, N, 4 and n before it",
                 all);
    }
    letters.remove_prefix(length);
  }
  header.attributes = header.extras > 0 || header.colors;
  if (!any_dimension) return;
  const std::uint32_t dimension = words.count("number of dimensions");
  if (dimension != 3) words.fail("vertices of {} dimensions are not supported; expected 3", dimension);
}

OffHeader read_header(OffWords& words) {
  OffHeader header;
  std::string_view word = words.next("the word OFF");
  const std::string_view whole = word;
  if (word.ends_with("OFF") || word == "off") {  // the word may be missing altogether
    word.remove_suffix(3);
    read_letters(word, header, words);
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
  // The number of edges is unused, and some files omit it.
  std::size_t more = 0;
  while (parse_real(words.next_on_line())) ++more;
  if (more > 3) {
    words.fail(
        "{} numbers follow the numbers of vertices, faces and edges on their line; the vertices must begin on the next "
        "line",
        more - 1);
  }
  words.skip_rest_of_line();
  // A vertex takes at least the bytes "0 0 0 ", a face "0 ": a wrong header must not cause a large allocation.
  if (header.vertices * 6ull + header.faces * 2ull > words.bytes_left() + 1ull) {
    words.fail(
        "the header promises {} vertices and {} faces, more than the file's remaining {} bytes can hold; it is "
        "damaged or truncated",
        header.vertices, header.faces, words.bytes_left());
  }
  return header;
}

/// Returns whether each vertex has its own line. Then words after its coordinates belong to the vertex, regardless of
/// the header: many writers put colours there without the letter C. True if each of the first lines holds a vertex and
/// enough lines for the faces follow. Reads ahead on a copy of the words.
bool has_line_for_each(OffWords words, const OffHeader& header) {
  const std::size_t needed = (header.homogeneous ? 4u : 3u) + header.extras;
  std::uint64_t lines = 0;
  while (lines < std::uint64_t{header.vertices} + header.faces && words.next_line()) {
    std::size_t count = 0;
    while (count < needed && !words.next_on_line().empty()) ++count;
    if (count == 0) continue;
    if (lines < header.vertices && count < needed) return false;
    ++lines;
  }
  return lines == std::uint64_t{header.vertices} + header.faces;
}

class OffReader {
 public:
  OffReader(std::string_view text, const std::string& file) : words_(text, file), file_(file), faces_(mesh_.soup) {}

  mesh::ImportedMesh read() {
    header_ = read_header(words_);
    by_lines_ = has_line_for_each(words_, header_);
    mesh_.soup.positions.reserve(header_.vertices);
    for (std::uint32_t i = 0; i < header_.vertices; ++i) read_vertex();
    for (std::uint32_t face = 0; face < header_.faces; ++face) read_face(face);
    faces_.require_all(header_.faces, file_);
    mesh_.notes = faces_.notes();
    read_rest();
    settle_unused_vertices(mesh_, [&](std::uint32_t v) {
      const auto found = std::ranges::find(wild_, v, &std::pair<std::uint32_t, std::size_t>::first);
      const glm::dvec3& p = mesh_.soup.positions[v];
      throw InputError("{}: line {}: vertex {} is not finite: ({}, {}, {})", file_, found->second, v, p.x, p.y, p.z);
    });
    if (mesh_.soup.triangles.empty()) {
      throw InputError("{}: there are no triangles in it ({} vertices, {})", file_, header_.vertices,
                       faces_.instead_of_surfaces());
    }
    if (header_.attributes) mesh_.notes.emplace_back("vertex colours, normals or texture coordinates ignored");
    if (longer_ > 0 && !header_.attributes) {
      mesh_.notes.push_back(
          fmt::format("{} vertices have more numbers than the header's letters say (colours?): ignored", longer_));
    }
    return std::move(mesh_);
  }

 private:
  void read_vertex() {
    glm::dvec3 position;
    for (glm::length_t axis = 0; axis < 3; ++axis) position[axis] = words_.real("coordinate");
    if (header_.homogeneous) position /= words_.real("coordinate");
    if (by_lines_) {
      const bool is_longer = !words_.next_on_line().empty();
      if (!header_.attributes && is_longer != (longer_ == mesh_.soup.positions.size()) &&
          !mesh_.soup.positions.empty()) {
        words_.fail("vertex {} has {} numbers than the vertices before it; the header does not match the file",
                    mesh_.soup.positions.size(), is_longer ? "more" : "fewer");
      }
      longer_ += is_longer ? 1 : 0;
      words_.skip_rest_of_line();
    } else if (header_.colors) {
      words_.skip_rest_of_line();
    } else {
      for (std::uint32_t i = 0; i < header_.extras; ++i) words_.real("vertex attribute");
    }
    if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z)) {
      wild_.emplace_back(static_cast<std::uint32_t>(mesh_.soup.positions.size()), words_.line_number());
    }
    mesh_.soup.positions.push_back(position);
  }

  void read_face(std::uint32_t face) {
    corners_.clear();
    const std::uint32_t count = words_.count("number of corners");
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t index = words_.count("vertex number");
      if (index >= header_.vertices) {
        words_.fail("face {} names vertex {}, but there are only {} (numbered from 0)", face, index, header_.vertices);
      }
      corners_.push_back(index);
    }
    words_.skip_rest_of_line();  // skips the face's colour
    faces_.add(corners_);
  }

  /// Reads the rest after the last face. A line that could be another face is an error: the header does not fit the
  /// file, and the elements read so far may be wrong.
  void read_rest() {
    std::uint64_t lines = 0;
    std::size_t first = 0;
    while (words_.next_line()) {
      std::string_view word = words_.next_on_line();
      if (word.empty()) continue;
      if (lines++ == 0) first = words_.line_number();
      const auto count = parse_number<std::uint32_t>(word);
      if (!count || *count < 3) continue;
      std::uint32_t corners = 0;
      while (!(word = words_.next_on_line()).empty()) {
        const auto index = parse_number<std::uint32_t>(word);
        if (!index || *index >= header_.vertices) break;
        ++corners;
      }
      if (corners < *count) continue;
      words_.fail(
          "a face follows the last of the {} that the header promises; the header does not fit the file, which may "
          "have numbers behind its vertices that it does not announce (COFF, NOFF)",
          header_.faces);
    }
    if (lines > 0) {
      mesh_.notes.push_back(fmt::format("{} lines after the last face ignored, the first is line {}", lines, first));
    }
  }

  OffWords words_;
  const std::string& file_;
  OffHeader header_;
  bool by_lines_ = false;
  mesh::ImportedMesh mesh_;
  FaceCollector faces_;
  std::vector<std::uint32_t> corners_;
  std::vector<std::pair<std::uint32_t, std::size_t>> wild_;  ///< vertices that are not finite, and their lines
  std::uint64_t longer_ = 0;                                 ///< number of vertices with further numbers on their lines
};

}  // namespace

mesh::ImportedMesh read_off_text(std::string_view text, const std::string& file) {
  return OffReader(text, file).read();
}

}  // namespace penumbra::import
