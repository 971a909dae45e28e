#include "import/ply.hpp"

#include "import/faces.hpp"
#include "import/text.hpp"
#include "import/ply_header.hpp"

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace penumbra::mesh {
namespace {

/// The numbers of a text, element by element: each begins on a line of its own, and may go on over several.
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
    const auto value = parse_number<double>(word);
    if (!value) fail("'{}' is not a number", word);
    return *value;
  }
  /// What stands on the line beyond the properties that the header declares.
  void end_element() {
    if (!take_word(line_).empty()) ++lines_with_more_;
    line_ = {};
  }
  [[nodiscard]] std::size_t bytes_left() const { return text_.size() + line_.size(); }
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

/// The numbers of a binary body.
class BinaryNumbers {
 public:
  BinaryNumbers(const PlyHeader& header, const std::string& file)
      : bytes_(header.body), size_(header.body.size()), file_(file), swap_(header.format == PlyFormat::big_endian) {}

  double number(PlyType type) {
    switch (type) {
      case PlyType::int8:
        return take<std::int8_t>();
      case PlyType::uint8:
        return take<std::uint8_t>();
      case PlyType::int16:
        return take<std::int16_t>();
      case PlyType::uint16:
        return take<std::uint16_t>();
      case PlyType::int32:
        return take<std::int32_t>();
      case PlyType::uint32:
        return take<std::uint32_t>();
      case PlyType::float32:
        return static_cast<double>(take<float>());
      default:
        return take<double>();
    }
  }
  void end_element() {}
  [[nodiscard]] std::size_t bytes_left() const { return bytes_.size(); }
  static std::uint64_t lines_with_more() { return 0; }
  static std::size_t least_size(PlyType type) { return size_of(type); }

  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError("{}: byte {} after the header: {}", file_, size_ - bytes_.size(),
                     text_for_people(format, std::forward<Args>(args)...));
  }

 private:
  template <typename Number>
  Number take() {
    std::array<char, sizeof(Number)> raw;
    if (bytes_.size() < raw.size()) fail("the file ends in the middle of an element; it is truncated");
    std::memcpy(raw.data(), bytes_.data(), raw.size());
    bytes_.remove_prefix(raw.size());
    if (swap_) std::ranges::reverse(raw);
    Number value;
    std::memcpy(&value, raw.data(), raw.size());
    return value;
  }

  std::string_view bytes_;
  std::size_t size_;
  const std::string& file_;
  bool swap_;
};

/// What a property is to us.
enum class Role : std::uint8_t { none, x, y, z, corners };

template <typename Numbers>
class PlyReader {
 public:
  PlyReader(const PlyHeader& header, const std::string& file)
      : header_(header), file_(file), numbers_(header, file), faces_(mesh_.soup) {
    for (const PlyElement& element : header.elements) {
      if (element.name == "vertex") vertices_ += element.count;
    }
    if (vertices_ > std::numeric_limits<std::uint32_t>::max())
      throw InputError("{}: more than 4,294,967,295 vertices", file);
  }

  ImportedMesh read() {
    for (const PlyElement& element : header_.elements) read_element(element);
    add_faces();
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
    for (std::uint64_t i = 0; i < element.count; ++i) {
      glm::dvec3 position(0);
      corners_.clear();
      for (std::size_t p = 0; p < roles.size(); ++p) read_property(element.properties[p], roles[p], position);
      numbers_.end_element();
      if (vertex) add_vertex(position, i);
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

  void add_vertex(const glm::dvec3& p, std::uint64_t number) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      numbers_.fail("vertex {} is not finite: ({}, {}, {})", number, p.x, p.y, p.z);
    }
    mesh_.soup.positions.push_back(p);
  }

  std::uint32_t vertex_named(double index) const {
    if (!(index >= 0 && index < static_cast<double>(vertices_)) || index != std::floor(index)) {
      numbers_.fail("face {} names vertex {}, but there are only {} (numbered from 0)", face_ends_.size(), index,
                    vertices_);
    }
    return static_cast<std::uint32_t>(index);
  }

  void keep_face() {
    for (const double index : corners_) kept_.push_back(vertex_named(index));
    face_ends_.push_back(kept_.size());
  }

  /// Every corner from the third on makes a triangle with the two before it; −1 begins a new strip.
  void keep_strip() {
    std::size_t length = 0;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      length = corners_[i] == -1 ? 0 : length + 1;
      if (length < 3) continue;
      const std::size_t turn = length % 2;  // of every other triangle, so that all have one winding
      for (const std::size_t back : {2 - (1 - turn), 1 + (1 - turn), std::size_t{0}}) {
        kept_.push_back(vertex_named(corners_[i - back]));
      }
      face_ends_.push_back(kept_.size());
    }
  }

  /// Only now, because faces may stand before the vertices.
  void add_faces() {
    std::size_t first = 0;
    mesh_.soup.triangles.reserve(face_ends_.size());
    for (const std::size_t end : face_ends_) {
      faces_.add(std::span(kept_).subspan(first, end - first));
      first = end;
    }
  }

  const PlyHeader& header_;
  const std::string& file_;
  Numbers numbers_;
  ImportedMesh mesh_;
  FaceCollector faces_;
  std::uint64_t vertices_ = 0;
  std::vector<double> corners_;         ///< of the element that is being read, as the file says
  std::vector<std::uint32_t> kept_;     ///< corners of all faces, one after the other
  std::vector<std::size_t> face_ends_;  ///< into `kept_`
};

}  // namespace

ImportedMesh read_ply(std::string_view content, const std::string& file) {
  const PlyHeader header = read_ply_header(content, file);
  if (header.format == PlyFormat::ascii) return PlyReader<AsciiNumbers>(header, file).read();
  return PlyReader<BinaryNumbers>(header, file).read();
}

}  // namespace penumbra::mesh
