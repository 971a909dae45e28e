// SPDX-License-Identifier: Apache-2.0
// Reads PLY files, ASCII or binary, in double precision.

#include "import/ply.hpp"

#include "import/faces.hpp"
#include "import/ply_binary.hpp"
#include "import/ply_header.hpp"
#include "import/text.hpp"

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <type_traits>

namespace penumbra::import {
namespace {

/// The numbers of a text, element by element: each element begins on a new line, and may extend over several.
class AsciiNumbers {
 public:
  AsciiNumbers(const PlyHeader& header, const std::string& file)
      : text_(header.body), file_(file), line_number_(header.lines) {}

  double number(PlyType) {
    std::string_view word;
    while ((word = take_word(line_)).empty()) {
      if (!take_line(text_, line_)) fail("the file ends in the middle of an element; it is truncated");
      ++line_number_;
    }
    const auto value = parse_real(word);
    if (!value) fail("'{}' is not a number", word);
    return *value;
  }
  /// Skips the rest of the line after the declared properties, and counts lines that have more.
  void end_element() {
    if (!take_word(line_).empty()) ++lines_with_more_;
    line_ = {};
  }
  [[nodiscard]] std::size_t bytes_left() const { return text_.size() + line_.size(); }
  /// Returns whether anything but blanks remains.
  [[nodiscard]] bool has_more() const {
    std::string_view rest = text_;
    return !take_word(rest).empty();
  }
  [[nodiscard]] std::uint64_t lines_with_more() const { return lines_with_more_; }
  static std::size_t least_size(PlyType) { return 1; }

  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError("{}: line {}: {}", file_, line_number_, text_for_people(format, std::forward<Args>(args)...));
  }

 private:
  std::string_view text_, line_;
  const std::string& file_;
  std::size_t line_number_;
  std::uint64_t lines_with_more_ = 0;
};

/// The reader's use of a property.
enum class Role : std::uint8_t { none, x, y, z, corners };

template <typename Numbers>
class PlyReader {
 public:
  PlyReader(const PlyHeader& header, const std::string& file, bool many_at_once)
      : header_(header), file_(file), numbers_(header, file), many_at_once_(many_at_once), faces_(mesh_.soup) {
    for (const PlyElement& element : header.elements) {
      if (element.name == "vertex") vertices_ += element.count;
    }
    if (vertices_ > std::numeric_limits<std::uint32_t>::max())
      throw InputError("{}: more than 4,294,967,295 vertices", file);
  }

  mesh::ImportedMesh read() {
    for (const PlyElement& element : header_.elements) read_element(element);
    add_waiting_faces();
    faces_.require_all(held_, file_);
    settle_unused_vertices(mesh_, [&](std::uint32_t v) {
      const glm::dvec3& p = mesh_.soup.positions[v];
      throw InputError("{}: vertex {} is not finite: ({}, {}, {}) (numbered from 0)", file_, v, p.x, p.y, p.z);
    });
    if (mesh_.soup.triangles.empty()) {
      throw InputError("{}: there are no triangles in it ({} vertices, {})", file_, vertices_,
                       faces_.instead_of_surfaces());
    }
    auto notes = faces_.notes();
    mesh_.notes.insert(mesh_.notes.begin(), notes.begin(), notes.end());
    if (numbers_.lines_with_more() > 0) {
      mesh_.notes.push_back(
          fmt::format("{} lines have more numbers than the header declares", numbers_.lines_with_more()));
    }
    if (numbers_.has_more()) {
      mesh_.notes.push_back(fmt::format("{} bytes after the last element ignored", numbers_.bytes_left()));
    }
    return std::move(mesh_);
  }

 private:
  void read_element(const PlyElement& element) {
    const bool vertex = element.name == "vertex", strips = element.name == "tristrips";
    const bool face = element.name == "face" || strips;
    if (!vertex && !face && element.count > 0) {
      mesh_.notes.push_back(fmt::format("{} elements '{}' skipped", element.count, element.name));
    }
    const std::vector<Role> roles = roles_of(element, vertex, face);
    if (vertex) mesh_.soup.positions.reserve(mesh_.soup.positions.size() + element.count);
    if (face && !strips) held_ += element.count;
    vertices_known_ = mesh_.soup.positions.size() == vertices_ && kept_.empty() && face_ends_.empty();
    if (face && vertices_known_) faces_.expect(std::min<std::uint64_t>(element.count, numbers_.bytes_left() / 4));
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (many_at_once_ && vertex) i += take_vertices(element, roles, element.count - i);
      if (many_at_once_ && face && !strips) i += take_faces(element, roles, element.count - i);
      if (i == element.count) break;
      glm::dvec3 position(0);
      corners_.clear();
      for (std::size_t p = 0; p < roles.size(); ++p) read_property(element.properties[p], roles[p], position);
      numbers_.end_element();
      if (vertex) mesh_.soup.positions.push_back(position);
      if (strips) keep_strip();
      if (face && !strips) keep_face();
    }
  }

  [[nodiscard]] std::vector<Role> roles_of(const PlyElement& element, bool vertex, bool face) {
    std::vector<Role> roles;
    std::string ignored;
    for (const PlyProperty& property : element.properties) {
      Role role = Role::none;
      if (vertex && !property.is_list && property.name.size() == 1) {
        const std::size_t axis = std::string_view("xyz").find(property.name);
        if (axis != std::string_view::npos) role = static_cast<Role>(static_cast<std::size_t>(Role::x) + axis);
      }
      if (face && property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index")) {
        role = Role::corners;
      }
      if (role == Role::none) ignored += " " + property.name;
      roles.push_back(role);
    }
    if (face && std::ranges::count(roles, Role::corners) == 0) take_other_list(element, roles, ignored);
    for (const Role wanted : {Role::x, Role::y, Role::z, Role::corners}) {
      const bool needed = wanted == Role::corners ? face : vertex;
      if (!needed || std::ranges::count(roles, wanted) == 1) continue;
      throw InputError("{}: PLY header: element '{}' needs one property {}", file_, element.name,
                       wanted == Role::corners ? "list … vertex_indices"
                                               : std::string(1, "xyz"[static_cast<std::size_t>(wanted) - 1]));
    }
    if ((vertex || face) && !ignored.empty()) {
      mesh_.notes.push_back(fmt::format("ignored properties of '{}':{}", element.name, ignored));
    }
    return roles;
  }

  /// Without a list of a usual name, the only list of integers is taken for the corners.
  void take_other_list(const PlyElement& element, std::vector<Role>& roles, std::string& ignored) {
    std::optional<std::size_t> only;
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (!property.is_list || property.type == PlyType::float32 || property.type == PlyType::float64) continue;
      if (only) return;
      only = i;
    }
    if (!only) return;
    const std::string& name = element.properties[*only].name;
    roles[*only] = Role::corners;
    ignored.erase(ignored.find(" " + name), name.size() + 1);
    mesh_.notes.push_back(fmt::format("the list '{}' of '{}' taken for its vertex_indices", name, element.name));
  }

  void read_property(const PlyProperty& property, Role role, glm::dvec3& position) {
    if (!property.is_list) {
      const double value = numbers_.number(property.type);
      if (role != Role::none) position[static_cast<glm::length_t>(role) - static_cast<glm::length_t>(Role::x)] = value;
      return;
    }
    const double length = numbers_.number(property.length_type);
    const std::size_t most = numbers_.bytes_left() / Numbers::least_size(property.type);
    if (!(length >= 0 && length <= static_cast<double>(most)) || length != std::floor(length)) {
      numbers_.fail("a list '{}' of {} numbers, but only {} bytes follow; the file is truncated or damaged",
                    property.name, length, numbers_.bytes_left());
    }
    for (std::uint64_t i = 0, count = static_cast<std::uint64_t>(length); i < count; ++i) {
      const double value = numbers_.number(property.type);
      if (role == Role::corners) corners_.push_back(value);
    }
  }

  /// Takes vertices in bulk where the format allows it; returns their number.
  std::uint64_t take_vertices(const PlyElement& element, const std::vector<Role>& roles, std::uint64_t most) {
    if constexpr (std::is_same_v<Numbers, BinaryNumbers>) {
      const auto place_of = [&](Role role) {
        return static_cast<std::size_t>(std::ranges::find(roles, role) - roles.begin());
      };
      return numbers_.take_vertices(element, {place_of(Role::x), place_of(Role::y), place_of(Role::z)}, most,
                                    mesh_.soup.positions);
    }
    return 0;
  }
  std::uint64_t take_faces(const PlyElement& element, const std::vector<Role>& roles, std::uint64_t most) {
    if constexpr (std::is_same_v<Numbers, BinaryNumbers>) {
      const auto corners = static_cast<std::size_t>(std::ranges::find(roles, Role::corners) - roles.begin());
      return numbers_.take_faces(element, corners, most, vertices_,
                                 [&](std::span<const std::uint32_t> face) { keep(face); });
    }
    return 0;
  }

  std::uint32_t vertex_named(double index) const {
    if (!(index >= 0 && index < static_cast<double>(vertices_)) || index != std::floor(index)) {
      numbers_.fail("face {} names vertex {}, but there are only {} (numbered from 0)", kept_faces_, index, vertices_);
    }
    return static_cast<std::uint32_t>(index);
  }

  /// Keeps a face until the vertices are known, which the file may list after the faces.
  void keep(std::span<const std::uint32_t> face) {
    ++kept_faces_;
    if (vertices_known_) return faces_.add(face);
    kept_.insert(kept_.end(), face.begin(), face.end());
    face_ends_.push_back(kept_.size());
  }

  void keep_face() {
    face_.clear();
    for (const double index : corners_) face_.push_back(vertex_named(index));
    keep(face_);
  }

  /// Every corner from the third on makes a triangle with its two predecessors; −1 begins a new strip.
  void keep_strip() {
    std::size_t length = 0;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      length = corners_[i] == -1 ? 0 : length + 1;
      if (length < 3) continue;
      ++held_;
      const std::size_t turn = length % 2;  // reverses every other triangle, so that all have the same winding
      face_.clear();
      for (const std::size_t back : {2 - (1 - turn), 1 + (1 - turn), std::size_t{0}}) {
        face_.push_back(vertex_named(corners_[i - back]));
      }
      keep(face_);
    }
  }

  void add_waiting_faces() {
    std::size_t first = 0;
    faces_.expect(std::min(face_ends_.size(), kept_.size() / 3));
    for (const std::size_t end : face_ends_) {
      faces_.add(std::span(kept_).subspan(first, end - first));
      first = end;
    }
  }

  const PlyHeader& header_;
  const std::string& file_;
  Numbers numbers_;
  bool many_at_once_;
  mesh::ImportedMesh mesh_;
  FaceCollector faces_;
  std::uint64_t vertices_ = 0;
  std::vector<double> corners_;  ///< corners of the current element, as stored in the file
  bool vertices_known_ = false;  ///< all promised vertices were read
  std::uint64_t kept_faces_ = 0;
  std::uint64_t held_ = 0;              ///< faces that the header counts, and triangles of strips
  std::vector<std::uint32_t> face_;     ///< corners of the last face
  std::vector<std::uint32_t> kept_;     ///< corners of all kept faces, one face after the other
  std::vector<std::size_t> face_ends_;  ///< into `kept_`
};

}  // namespace

mesh::ImportedMesh read_ply(std::string_view content, const std::string& file) {
  const PlyHeader header = read_ply_header(content, file);
  if (header.format == PlyFormat::ascii) return PlyReader<AsciiNumbers>(header, file, false).read();
  return PlyReader<BinaryNumbers>(header, file, true).read();
}

mesh::ImportedMesh read_ply_slowly(std::string_view content, const std::string& file) {
  const PlyHeader header = read_ply_header(content, file);
  return PlyReader<BinaryNumbers>(header, file, false).read();
}

}  // namespace penumbra::import
