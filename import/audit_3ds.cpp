// SPDX-License-Identifier: Apache-2.0
// Checks the chunk sizes and counts of 3D Studio files before Assimp reads them.

#include "import/audit_3ds.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace penumbra::import {
namespace {

constexpr std::size_t kChunkHeader = 6;  // bytes of a chunk's number and of its length, which includes these six bytes

std::uint32_t little_endian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = count; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// Chunks that contain chunks, as Assimp reads them; chunks of materials contain no counted elements.
constexpr std::array<std::uint32_t, 12> kContainers = {0x4D4D, 0x3DC2, 0x3D3D, 0x4100, 0xAFFF, 0xB000,
                                                       0xB002, 0xB003, 0xB004, 0xB005, 0xB006, 0xB007};
constexpr std::uint32_t kObject = 0x4000;  ///< a name, then chunks
constexpr std::uint32_t kFaces = 0x4120;   ///< a count, faces, then chunks

/// Chunks that contain a count of elements.
struct Counted {
  std::uint32_t number;
  std::size_t skip;   ///< bytes before the count
  std::size_t width;  ///< bytes of the count
  std::size_t bytes;  ///< least bytes of one counted element
};
constexpr std::array<Counted, 8> kCounted = {{{0x4110, 0, 2, 12},  // vertices
                                              {kFaces, 0, 2, 8},
                                              {0x4140, 0, 2, 8},    // texture coordinates
                                              {0xB020, 10, 4, 18},  // keys: time, flags, and a vector
                                              {0xB021, 10, 4, 22},  // keys with a rotation
                                              {0xB022, 10, 4, 18},  // keys with a vector
                                              {0xB023, 10, 4, 10},  // keys with an angle
                                              {0xB024, 10, 4, 10}}};

struct Span {
  std::size_t first, end;
};

}  // namespace

void audit_3ds(std::string_view content, const std::string& file) {
  std::vector<Span> waiting = {{0, content.size()}};
  while (!waiting.empty()) {  // no recursion: a file may nest a million chunks
    Span span = waiting.back();
    waiting.pop_back();
    while (span.end - span.first >= kChunkHeader) {
      const std::uint32_t number = little_endian(content, span.first, 2),
                          length = little_endian(content, span.first + 2, 4);
      if (length < kChunkHeader || length > span.end - span.first) {
        // Some writers put zeros or other padding after the last chunk of the file.
        if (span.end == content.size() && span.first > 0 && waiting.empty() && number == 0) break;
        throw InputError(
            "{}: the chunk {:#06x} at byte {} says that it has {} bytes, but there are {}; the file is "
            "truncated or damaged",
            file, number, span.first, length, span.end - span.first);
      }
      Span inside{span.first + kChunkHeader, span.first + length};
      if (number == kObject) {
        const std::size_t name_end = content.find('\0', inside.first);
        inside.first = std::min(name_end == std::string_view::npos ? inside.end : name_end + 1, inside.end);
        waiting.push_back(inside);
      } else if (std::ranges::find(kContainers, number) != kContainers.end()) {
        waiting.push_back(inside);
      }
      const auto* const counted = std::ranges::find(kCounted, number, &Counted::number);
      if (counted != kCounted.end()) {
        const std::size_t room = inside.end - inside.first;
        const std::size_t before = counted->skip + counted->width;
        const std::uint64_t count =
            room >= before ? little_endian(content, inside.first + counted->skip, counted->width) : 0;
        if (room < before + count * counted->bytes) {
          throw InputError(
              "{}: the chunk {:#06x} at byte {} says that it holds {} entries, for which its {} bytes are "
              "too few; the file is truncated or damaged",
              file, number, span.first, count, room);
        }
        if (number == kFaces) waiting.push_back({inside.first + 2 + static_cast<std::size_t>(count) * 8, inside.end});
      }
      span.first += length;
    }
  }
}

}  // namespace penumbra::import
