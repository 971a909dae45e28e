// SPDX-License-Identifier: Apache-2.0
#pragma once

// Makes pictures byte by byte, and scenes under textured lights.

#include "scenes/scene.hpp"
#include "tests/unit/visibility/scenes.hpp"

#include <glm/vec3.hpp>
#include <zlib.h>

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::tests {

using ColorAt = std::function<glm::vec3(std::uint32_t x, std::uint32_t y)>;

inline scenes::Texture texture_of(std::uint32_t width, std::uint32_t height, const ColorAt& color_at) {
  scenes::Texture texture{"made by hand", width, height, {}};
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) texture.texels.push_back(color_at(x, y));
  }
  return texture;
}

inline scenes::Texture constant_texture(std::uint32_t width, std::uint32_t height, const glm::vec3& color) {
  return texture_of(width, height, [&](std::uint32_t, std::uint32_t) { return color; });
}

inline std::string big_endian(std::uint32_t value) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(value >> shift & 0xff);
  return text;
}

inline std::string png_chunk(const std::string& kind, const std::string& data) {
  const std::string body = kind + data;
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  return big_endian(static_cast<std::uint32_t>(data.size())) + body + big_endian(static_cast<std::uint32_t>(sum));
}

/// Returns a PNG file. `kind`: 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGB and alpha. `rows`: the data of the
/// file's rows, each without its filter byte. `more`: chunks between header and picture.
inline std::string png_file(std::uint32_t width, std::uint32_t height, int depth, int kind,
                            const std::vector<std::string>& rows, const std::string& more = {}) {
  std::string plain;
  for (const std::string& row : rows) plain += std::string(1, '\0') + row;
  uLongf size = compressBound(static_cast<uLong>(plain.size()));
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(plain.data()),
           static_cast<uLong>(plain.size()));
  packed.resize(size);
  const std::string header = big_endian(width) + big_endian(height) + static_cast<char>(depth) +
                             static_cast<char>(kind) + std::string(3, '\0');
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) + more + png_chunk("IDAT", packed) + png_chunk("IEND", "");
}

inline std::string bytes_of(std::initializer_list<int> values) {
  std::string text;
  for (const int value : values) text += static_cast<char>(value);
  return text;
}

/// A tilted board over a floor under a square light of half-size 1 at height 4, with coordinates that are exact in
/// float.
inline scenes::Scene board_under_light(std::optional<scenes::Texture> texture) {
  scenes::Scene scene;
  add_object(scene, "floor", quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  add_object(scene, "board", quad({0.125, 1, 0}, {1, 0.25, 0}, {0, 0.125, -1}));
  scene.lights.push_back(ceiling_light(4, 1));
  scene.lights.back().texture = std::move(texture);
  scene.cameras.push_back(camera({0.3, 2.7, 6}, {0, 0.3, 0}));
  return scene;
}

}  // namespace penumbra::tests
