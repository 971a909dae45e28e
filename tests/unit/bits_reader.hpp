// SPDX-License-Identifier: Apache-2.0
#pragma once

// Reads `--bits` files for tests; visibility/masks/bits_file.hpp has the format.

#include "base/assert.hpp"
#include "base/error.hpp"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

namespace penumbra::tests {

struct BitsFile {
  std::uint32_t width = 0, height = 0, sample_count = 0;
  glm::dvec3 origin{0};
  std::vector<glm::vec3> light_points;
  std::vector<glm::vec3> p;  ///< one for each pixel, as is `triangle`
  std::vector<std::int32_t> triangle;
  std::vector<std::uint32_t> masks;  ///< words_per_mask() words for each pixel

  [[nodiscard]] std::uint32_t words_per_mask() const { return (sample_count + 31) / 32; }
};

namespace bits_reader {

/// Reads values one after another from the front; the caller has checked that there are enough bytes.
class Reader {
 public:
  explicit Reader(std::span<const char> bytes) : bytes_(bytes) {}
  template <typename Value>
  void take(Value& value) {
    PENUMBRA_ASSERT(bytes_.size() >= sizeof(Value), "{} bytes left", bytes_.size());
    std::memcpy(&value, bytes_.data(), sizeof(Value));
    bytes_ = bytes_.subspan(sizeof(Value));
  }

 private:
  std::span<const char> bytes_;
};

}  // namespace bits_reader

/// Throws InputError for a file of another format, or one that is too short or too long.
inline BitsFile read_bits(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError("cannot read \"{}\"", path.string());
  const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  BitsFile file;
  const std::string line = bytes.substr(0, std::min(bytes.find('\n'), std::size_t{100}));
  char rest = 0;
  const int found =
      std::sscanf(line.c_str(), "penumbra-bits/1 %9u %9u %4u%c", &file.width, &file.height, &file.sample_count, &rest);
  if (found != 3 || file.sample_count == 0) {
    throw InputError("\"{}\" does not begin with a line \"penumbra-bits/1 W H N\"", path.string());
  }
  const std::size_t pixel_count = std::size_t{file.width} * file.height;
  const std::size_t pixel_bytes = 16 + 4 * std::size_t{file.words_per_mask()};
  const std::size_t expected = line.size() + 1 + 24 + 12 * std::size_t{file.sample_count} + pixel_count * pixel_bytes;
  if (bytes.size() != expected) {
    throw InputError("\"{}\" has {} bytes, but {}x{} pixels and {} light samples take {}", path.string(), bytes.size(),
                     file.width, file.height, file.sample_count, expected);
  }
  bits_reader::Reader reader(std::span<const char>(bytes).subspan(line.size() + 1));
  reader.take(file.origin);
  file.light_points.resize(file.sample_count);
  for (glm::vec3& point : file.light_points) reader.take(point);
  file.p.resize(pixel_count);
  file.triangle.resize(pixel_count);
  file.masks.resize(pixel_count * file.words_per_mask());
  for (std::size_t i = 0; i < pixel_count; ++i) {
    reader.take(file.p[i]);
    reader.take(file.triangle[i]);
    for (std::size_t w = 0; w < file.words_per_mask(); ++w) reader.take(file.masks[i * file.words_per_mask() + w]);
  }
  return file;
}

}  // namespace penumbra::tests
