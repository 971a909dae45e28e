#include "mesh/import_wire.hpp"

#include "mesh/import.hpp"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra::mesh {
namespace {

/// Length of the well-formed UTF-8 sequence that `text` (not empty) starts with; 0 if it is ill-formed.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  const std::size_t length = lead < 0x80   ? 1
                             : lead < 0xC2 ? 0
                             : lead < 0xE0 ? 2
                             : lead < 0xF0 ? 3
                             : lead < 0xF5 ? 4
                                           : 0;
  if (length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  // Overlong forms, surrogates and what lies beyond U+10FFFF all show in the second byte.
  if ((lead == 0xE0 && byte(1) < 0xA0) || (lead == 0xED && byte(1) > 0x9F) || (lead == 0xF0 && byte(1) < 0x90) ||
      (lead == 0xF4 && byte(1) > 0x8F)) {
    return 0;
  }
  if (lead == 0xC2 && byte(1) < 0xA0) return 0;  // C1 control characters: terminals obey these, too
  return length;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    const bool control = static_cast<unsigned char>(text[0]) < 0x20 || text[0] == 0x7F;
    if (length == 0 || control) {
      result += '?';
      text.remove_prefix(1);
    } else {
      result += text.substr(0, length);
      text.remove_prefix(length);
    }
  }
  return result;
}

std::string WireReader::get_string() {
  const std::vector<char> raw = get_array<char>();
  return printable({raw.data(), raw.size()});
}

std::vector<std::string> WireReader::get_strings() {
  const auto count = get<std::uint64_t>();
  if (count > rest_.size() / sizeof(std::uint64_t)) throw WireError("a list is longer than the answer");
  std::vector<std::string> texts(count);
  for (std::string& text : texts) text = get_string();
  return texts;
}

std::vector<std::string> WireReader::get_raw_strings() {
  const auto count = get<std::uint64_t>();
  if (count > rest_.size() / sizeof(std::uint64_t)) throw WireError("a list is longer than the answer");
  std::vector<std::string> texts(count);
  for (std::string& text : texts) {
    const std::vector<char> raw = get_array<char>();
    text.assign(raw.begin(), raw.end());
  }
  return texts;
}

void check_soup(const TriangleSoup& soup) {
  if (soup.object.size() != soup.triangles.size() || soup.source_face.size() != soup.triangles.size()) {
    throw WireError("the triangle arrays differ in length");
  }
  const auto finite = [](const glm::dvec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  if (!std::ranges::all_of(soup.positions, finite)) throw WireError("a position is not finite");
  const auto in_range = [&](std::uint32_t index) { return index < soup.positions.size(); };
  for (const Triangle& triangle : soup.triangles) {
    if (!std::ranges::all_of(triangle, in_range)) throw WireError("a vertex index is out of range");
  }
}

void put_mesh(WireWriter& to, const ImportedMesh& mesh) {
  to.put_array(std::span<const glm::dvec3>(mesh.soup.positions));
  to.put_array(std::span<const Triangle>(mesh.soup.triangles));
  to.put_array(std::span<const std::uint32_t>(mesh.soup.object));
  to.put_array(std::span<const std::uint32_t>(mesh.soup.source_face));
  to.put_strings(mesh.notes);
}

ImportedMesh get_mesh(WireReader& from) {
  ImportedMesh mesh;
  mesh.soup.positions = from.get_array<glm::dvec3>();
  mesh.soup.triangles = from.get_array<Triangle>();
  mesh.soup.object = from.get_array<std::uint32_t>();
  mesh.soup.source_face = from.get_array<std::uint32_t>();
  mesh.notes = from.get_strings();
  check_soup(mesh.soup);
  return mesh;
}

}  // namespace penumbra::mesh
