// SPDX-License-Identifier: Apache-2.0
#include "tests/agreement/mesh/face_counters.hpp"

#include <nlohmann/json.hpp>

#include <bit>
#include <cstring>
#include <set>
#include <stdexcept>

namespace penumbra::test {
namespace {

/// Reads numbers from a file's bytes one after another; throws at the end of the bytes.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes, bool big_endian = false) : bytes_(bytes), big_endian_(big_endian) {}

  template <typename Number>
  Number take() {
    Number value{};
    char raw[sizeof(Number)];
    for (std::size_t i = 0; i < sizeof(Number); ++i) raw[big_endian_ ? sizeof(Number) - 1 - i : i] = bytes_.at(at_ + i);
    std::memcpy(&value, raw, sizeof(Number));
    at_ += sizeof(Number);
    return value;
  }
  std::string_view take(std::size_t count) {
    if (count > bytes_.size() - at_) throw std::out_of_range("the file ends too early");
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

 private:
  std::string_view bytes_;
  bool big_endian_;
  std::size_t at_ = 0;
};

/// Chunks of 3D Studio have a number, a length that includes these six bytes, and content.
std::uint64_t count_3ds_chunks(std::string_view bytes) {
  std::uint64_t faces = 0;
  Cursor from(bytes);
  while (from.left() >= 6) {
    const auto number = from.take<std::uint16_t>();
    const auto length = from.take<std::uint32_t>();
    if (length < 6) break;
    std::string_view content = from.take(std::min<std::size_t>(length - 6, from.left()));
    if (number == 0x4000) content.remove_prefix(content.find('\0') + 1);  // skips an object's name
    if (number == 0x4D4D || number == 0x3D3D || number == 0x4000 || number == 0x4100)
      faces += count_3ds_chunks(content);
    if (number == 0x4120) faces += Cursor(content).take<std::uint16_t>();
  }
  return faces;
}

std::size_t size_of_ply(std::string_view type) {
  static const std::map<std::string_view, std::size_t> sizes = {
      {"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},  {"short", 2}, {"ushort", 2},
      {"int16", 2}, {"uint16", 2},  {"int", 4},    {"uint", 4},   {"int32", 4}, {"uint32", 4},
      {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  return sizes.at(type);
}

struct PlyProperty {
  bool list = false;
  std::string_view count_type, type, name;
};
struct PlyElement {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

std::uint64_t integer_of_ply(Cursor& from, std::string_view type) {
  switch (size_of_ply(type)) {
    case 1:
      return from.take<std::uint8_t>();
    case 2:
      return from.take<std::uint16_t>();
    default:
      return from.take<std::uint32_t>();
  }
}

}  // namespace

FaceCount count_3ds(const std::filesystem::path& file) {
  return count_3ds_chunks(bytes_of_file(file));
}

FaceCount count_ply(const std::filesystem::path& file) {
  const std::string bytes = bytes_of_file(file);
  std::size_t at = bytes.find("end_header");
  const std::string_view header = std::string_view(bytes).substr(0, at);
  at = bytes.find('\n', at) + 1;
  std::vector<PlyElement> elements;
  std::string_view format;
  for (const std::string_view line : lines_of(header)) {
    const auto words = words_of(line);
    if (words.empty()) continue;
    if (words[0] == "format") format = words.at(1);
    if (words[0] == "element") elements.push_back({words.at(1), std::stoull(std::string(words.at(2))), {}});
    if (words[0] != "property") continue;
    const bool list = words.at(1) == "list";
    elements.back().properties.push_back(list ? PlyProperty{true, words.at(2), words.at(3), words.at(4)}
                                              : PlyProperty{false, {}, words.at(1), words.at(2)});
  }
  std::uint64_t faces = 0;
  const auto is_face = [](const PlyElement& element, const PlyProperty& property) {
    return element.name == "face" && (property.name == "vertex_index" || property.name == "vertex_indices");
  };
  const std::string_view body = std::string_view(bytes).substr(at);
  if (format == "ascii") {
    const auto words = words_of(body);
    std::size_t next = 0;
    for (const PlyElement& element : elements) {
      if (element.name == "tristrips") return std::nullopt;
      for (std::uint64_t i = 0; i < element.count; ++i) {
        for (const PlyProperty& property : element.properties) {
          const std::size_t count = property.list ? std::stoull(std::string(words.at(next))) : 0;
          if (is_face(element, property) && count >= 3) ++faces;
          next += 1 + count;
        }
      }
    }
    if (next != words.size()) return std::nullopt;  // columns that the header does not declare
    return faces;
  }
  Cursor from(body, format == "binary_big_endian");
  for (const PlyElement& element : elements) {
    if (element.name == "tristrips") return std::nullopt;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) {
        const std::uint64_t count = property.list ? integer_of_ply(from, property.count_type) : 1;
        from.take(count * size_of_ply(property.type));
        if (is_face(element, property) && count >= 3) ++faces;
      }
    }
  }
  return faces;
}

FaceCount count_stl(const std::filesystem::path& file) {
  std::string bytes = bytes_of_file(file);
  if (bytes.size() >= 84) {
    Cursor from(bytes);
    from.take(80);
    const std::uint64_t count = from.take<std::uint32_t>();
    if (bytes.size() == 84 + 50 * count) return count;
  }
  for (char& c : bytes) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  std::uint64_t faces = 0;
  for (const std::string_view word : words_of(bytes)) faces += word == "endfacet" ? 1 : 0;
  return faces;
}

/// Interchange format of LightWave 6 and later: big-endian chunks, padded to even lengths.
FaceCount count_lwo(const std::filesystem::path& file) {
  const std::string bytes = bytes_of_file(file);
  Cursor from(bytes, true);
  if (from.take(4) != "FORM") throw std::runtime_error("no IFF file");
  from.take(4);
  const std::string_view kind = from.take(4);
  if (kind != "LWO2" && kind != "LXOB") return std::nullopt;
  std::uint64_t faces = 0;
  while (from.left() >= 8) {
    const std::string_view tag = from.take(4);
    const auto length = from.take<std::uint32_t>();
    const std::string_view content = from.take(std::min<std::size_t>(length, from.left()));
    if (length % 2 == 1 && from.left() > 0) from.take(1);
    if (tag != "POLS") continue;
    Cursor polygons(content, true);
    polygons.take(4);
    while (polygons.left() >= 2) {
      const int corners = kind == "LWO2" ? polygons.take<std::uint16_t>() & 0x3FF : polygons.take<std::uint16_t>();
      for (int i = 0; i < corners; ++i) {
        if (polygons.take<std::uint16_t>() >= 0xFF00) polygons.take(2);  // an index of four bytes
      }
      faces += corners >= 3 ? 1 : 0;
    }
  }
  return faces;
}

FaceCount count_md2(const std::filesystem::path& file) {
  const std::string bytes = bytes_of_file(file);
  Cursor from(bytes);
  from.take(32);  // skips eight other numbers
  return from.take<std::uint32_t>();
}

FaceCount count_ms3d(const std::filesystem::path& file) {
  const std::string bytes = bytes_of_file(file);
  Cursor from(bytes);
  from.take(14);  // skips a magic number and a version
  from.take(std::size_t{15} * from.take<std::uint16_t>());
  return from.take<std::uint16_t>();
}

FaceCount count_gltf(const std::filesystem::path& file) {
  std::string text = bytes_of_file(file);
  if (text.starts_with("glTF")) {
    Cursor from(text);
    from.take(12);
    const auto length = from.take<std::uint32_t>();
    from.take(4);
    text = std::string(from.take(length));
  }
  const auto document = nlohmann::json::parse(text);
  if (document["asset"]["version"] != "2.0") return std::nullopt;
  const auto corners_of = [&](const nlohmann::json& primitive) -> std::uint64_t {
    if (!primitive["attributes"].contains("POSITION")) return 0;
    const auto accessor = primitive.value("indices", primitive["attributes"]["POSITION"].get<int>());
    return document["accessors"][static_cast<std::size_t>(accessor)]["count"].get<std::uint64_t>();
  };
  std::vector<std::size_t> nodes;
  const std::size_t nodes_in_file = document.contains("nodes") ? document["nodes"].size() : 0;
  if (document.contains("scenes") && !document["scenes"].empty()) {
    const nlohmann::json& scene = document["scenes"][document.value("scene", std::size_t{0})];
    if (scene.contains("nodes")) nodes = scene["nodes"].get<std::vector<std::size_t>>();
  } else {  // all nodes that are no other node's children
    std::set<std::size_t> children;
    for (const auto& node : document["nodes"]) {
      if (node.contains("children")) children.insert(node["children"].begin(), node["children"].end());
    }
    for (std::size_t i = 0; i < nodes_in_file; ++i) {
      if (!children.contains(i)) nodes.push_back(i);
    }
  }
  std::uint64_t faces = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes.size() > nodes_in_file) throw std::runtime_error("nodes in a circle");
    const nlohmann::json& node = document["nodes"].at(nodes[i]);
    if (node.contains("children")) {
      for (const auto& child : node["children"]) nodes.push_back(child.get<std::size_t>());
    }
    if (!node.contains("mesh")) continue;
    for (const auto& primitive : document["meshes"][node["mesh"].get<std::size_t>()]["primitives"]) {
      const int mode = primitive.value("mode", 4);
      const std::uint64_t corners = corners_of(primitive);
      if (mode == 4) faces += corners / 3;
      if (mode > 4 && corners >= 3) faces += corners - 2;
    }
  }
  return faces;
}

}  // namespace penumbra::test
