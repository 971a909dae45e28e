// SPDX-License-Identifier: Apache-2.0
// The container of glTF 2.0, section 4.4.

#include "import/gltf/glb_chunks.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace penumbra::import {
namespace {

constexpr std::size_t kHeader = 12, kChunkHeader = 8;
constexpr std::string_view kJson("JSON", 4), kBinary("BIN\0", 4);

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

void put(std::string& bytes, std::size_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * i & 0xff);
}

std::size_t padded(std::size_t size) {
  return (size + 3) / 4 * 4;
}

/// Returns the offset of the chunk after the one that ends at `at`: some writers pad without counting the padding, some
/// do not pad.
std::size_t next_chunk(std::string_view bytes, std::size_t at) {
  const auto begins = [&](std::size_t place) {
    return place + kChunkHeader <= bytes.size() &&
           (bytes.substr(place + 4, 4) == kJson || bytes.substr(place + 4, 4) == kBinary);
  };
  if (begins(at) || !begins(padded(at))) return at;
  return padded(at);
}

/// Returns whether the bytes are only padding.
bool is_padding(std::string_view bytes) {
  return bytes.size() < 4 && std::ranges::all_of(bytes, [](char c) { return c == '\0' || c == ' '; });
}

}  // namespace

GlbChunks glb_chunks(std::string_view bytes, const std::string& file) {
  if (bytes.size() < kHeader + kChunkHeader)
    throw InputError("{}: a GLB of {} bytes; it is truncated", file, bytes.size());
  const std::uint32_t version = little_endian(bytes, 4), length = little_endian(bytes, 8);
  if (version != 2) throw InputError("{}: GLB version {}; expected 2. Export it again as glTF 2.0", file, version);
  if (length > bytes.size()) {
    throw InputError("{}: the GLB says it has {} bytes, but the file has {}; it is truncated", file, length,
                     bytes.size());
  }
  if (length < kHeader + kChunkHeader) {
    throw InputError("{}: the GLB says it has {} bytes, which is less than its header; it is damaged", file, length);
  }
  bytes = bytes.substr(0, length);
  GlbChunks chunks;
  std::size_t number = 0;
  for (std::size_t at = kHeader; at < bytes.size() && !(number > 0 && is_padding(bytes.substr(at))); ++number) {
    const std::size_t left = bytes.size() - at;
    const std::size_t size = left < kChunkHeader ? 0 : little_endian(bytes, at);
    if (left < kChunkHeader || size > left - kChunkHeader) {
      throw InputError("{}: the GLB chunk at byte {} reaches beyond the file's {} bytes; it is truncated or damaged",
                       file, at, length);
    }
    const std::string_view type = bytes.substr(at + 4, 4), content = bytes.substr(at + kChunkHeader, size);
    if (number == 0) {
      if (type != kJson) throw InputError("{}: the GLB's first chunk is not its JSON; it is damaged", file);
      chunks.json = content;
    } else if (type == kBinary && chunks.binary.empty()) {
      chunks.binary = content;
      chunks.strict &= number == 1 && size > 0;
    } else {
      chunks.strict &= number > 1;  // a parser may stop at the second chunk, not after it
    }
    chunks.strict &= size % 4 == 0;
    at = next_chunk(bytes, at + kChunkHeader + size);
  }
  return chunks;
}

std::string glb_of(std::string_view json, std::string_view binary) {
  const std::size_t length =
      kHeader + kChunkHeader + padded(json.size()) + (binary.empty() ? 0 : kChunkHeader + padded(binary.size()));
  if (length > std::numeric_limits<std::uint32_t>::max()) throw InputError("a GLB of more than 4 GiB");
  std::string bytes = "glTF";
  bytes.reserve(length);
  put(bytes, 2), put(bytes, length);
  put(bytes, padded(json.size()));
  bytes.append(kJson).append(json).append(padded(json.size()) - json.size(), ' ');
  if (!binary.empty()) {
    put(bytes, padded(binary.size()));
    bytes.append(kBinary).append(binary).append(padded(binary.size()) - binary.size(), '\0');
  }
  return bytes;
}

}  // namespace penumbra::import
