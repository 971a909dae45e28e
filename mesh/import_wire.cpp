// SPDX-License-Identifier: Apache-2.0
// Numbers, texts and meshes in the answers of the helper processes. The reader trusts no length: an answer may come
// from a process that a damaged file has taken over.

#include "mesh/import_wire.hpp"

#include "base/utf8.hpp"
#include "mesh/import.hpp"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cerrno>
#include <limits>

#include <unistd.h>

namespace penumbra::mesh {

std::string printable(std::string_view text) {
  return on_one_line(text);
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

std::vector<std::span<const std::byte>> WireWriter::pieces() const {
  std::vector<std::span<const std::byte>> pieces;
  const std::span<const std::byte> all(bytes_);
  std::size_t done = 0;
  for (const InPlace& piece : in_place_) {
    pieces.push_back(all.subspan(done, piece.after - done));
    pieces.push_back(piece.values);
    done = piece.after;
  }
  pieces.push_back(all.subspan(done));
  return pieces;
}

std::uint64_t WireWriter::size() const {
  std::uint64_t size = bytes_.size();
  for (const InPlace& piece : in_place_) size += piece.values.size();
  return size;
}

std::vector<std::byte> WireWriter::bytes() const {
  std::vector<std::byte> bytes;
  for (const auto piece : pieces()) bytes.insert(bytes.end(), piece.begin(), piece.end());
  return bytes;
}

bool write_all(int to, const mesh::WireWriter& from) {
  for (std::span<const std::byte> bytes : from.pieces()) {
    while (!bytes.empty()) {
      const ssize_t count = ::write(to, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
  }
  return true;
}

namespace {

void put_positions(WireWriter& to, const std::vector<glm::dvec3>& positions) {
  const bool single = std::ranges::all_of(positions, [](const glm::dvec3& p) { return glm::dvec3(glm::vec3(p)) == p; });
  to.put<std::uint8_t>(single ? 1 : 0);
  if (!single) return to.put_array_in_place(std::span<const glm::dvec3>(positions));
  to.put_values<glm::vec3>(positions.size(), [&](std::size_t i) { return glm::vec3(positions[i]); });
}

/// Writes numbers, most of which exceed their predecessor by `step`.
void put_numbers(WireWriter& to, std::span<const std::uint32_t> numbers, std::uint32_t step) {
  std::vector<NumberRun> runs;
  for (const std::uint32_t number : numbers) {
    const bool goes_on = !runs.empty() && number == runs.back().first + step * runs.back().count &&
                         runs.back().count < std::numeric_limits<std::uint32_t>::max();
    if (!goes_on) {
      if (runs.size() >= numbers.size() / 4) {
        to.put<std::uint8_t>(0);
        return to.put_array_in_place(numbers);
      }
      runs.push_back({number, 0});
    }
    ++runs.back().count;
  }
  to.put<std::uint8_t>(1);
  to.put_array(std::span<const NumberRun>(runs));
}

}  // namespace

void put_soup(WireWriter& to, const TriangleSoup& soup) {
  put_positions(to, soup.positions);
  to.put_array_in_place(std::span<const Triangle>(soup.triangles));
  put_numbers(to, soup.object, 0);
  put_numbers(to, soup.source_face, 1);
}

void put_mesh(WireWriter& to, const ImportedMesh& mesh) {
  put_soup(to, mesh.soup);
  to.put_strings(mesh.notes);
}

}  // namespace penumbra::mesh
