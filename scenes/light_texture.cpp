#include "scenes/light_texture.hpp"

#include "base/error.hpp"
#include "base/exr.hpp"
#include "base/png.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <span>
#include <system_error>
#include <vector>

namespace penumbra::scenes {
namespace {

constexpr std::array kPngMark = {std::byte{0x89}, std::byte{'P'}, std::byte{'N'}, std::byte{'G'}};
constexpr std::array kExrMark = {std::byte{0x76}, std::byte{0x2f}, std::byte{0x31}, std::byte{0x01}};
/// The largest picture that is read, uncompressed, with four 32-bit channels, and room for what else a file holds.
constexpr std::uintmax_t kMostBytes = std::uintmax_t{128} << 20;

std::vector<std::byte> read_bytes(const std::filesystem::path& file, const std::string& shown) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) throw InputError("\"{}\" is not a regular file", shown);
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) throw InputError("\"{}\": {}", shown, error.message());
  if (size > kMostBytes) {
    throw InputError("\"{}\" has {} bytes; a texture's file has at most {}", shown, size, kMostBytes);
  }
  std::vector<std::byte> bytes(size);
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!stream) throw InputError("\"{}\" cannot be read", shown);
  return bytes;
}

template <std::size_t kSize>
bool begins_with(std::span<const std::byte> bytes, const std::array<std::byte, kSize>& mark) {
  return bytes.size() >= kSize && std::ranges::equal(bytes.first(kSize), mark);
}

LinearImage read_exr_picture(const std::filesystem::path& file, const std::string& shown) {
  const ExrFile exr = read_exr(file, kLargestTextureSide);
  const std::array<const char*, 3> names =
      exr.floats.contains("Y") && !exr.floats.contains("R") ? std::array{"Y", "Y", "Y"} : std::array{"R", "G", "B"};
  std::array<const std::vector<float>*, 3> channels{};
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const auto found = exr.floats.find(names[c]);
    if (found == exr.floats.end()) {
      std::vector<std::string> present;
      for (const auto& [name, values] : exr.floats) present.push_back(name);
      throw InputError("\"{}\": no channel {} of floats; a texture has R, G and B, or Y alone; this file has: {}",
                       shown, names[c], fmt::join(present, ", "));
    }
    channels[c] = &found->second;
  }
  LinearImage image{exr.width, exr.height, {}};
  image.pixels.resize(std::size_t{exr.width} * exr.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = {(*channels[0])[i], (*channels[1])[i], (*channels[2])[i]};
  }
  return image;
}

LinearImage read_png_picture(std::span<const std::byte> bytes, const std::string& shown) {
  try {
    return decode_linear_png(bytes, kLargestTextureSide);
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("\"{}\": {}", shown, error.what()));
  }
}

}  // namespace

Texture read_texture(const std::filesystem::path& file, const std::string& shown) {
  const std::vector<std::byte> bytes = read_bytes(file, shown);
  const bool is_png = begins_with(bytes, kPngMark);
  if (!is_png && !begins_with(bytes, kExrMark)) {
    throw InputError("\"{}\" is neither a PNG nor an OpenEXR picture; a texture is one of the two", shown);
  }
  LinearImage image = is_png ? read_png_picture(bytes, shown) : read_exr_picture(file, shown);
  Texture texture{shown, image.width, image.height, std::move(image.pixels)};
  check_texture(texture, fmt::format("\"{}\"", shown));
  return texture;
}

void check_texture(const Texture& texture, const std::string& where) {
  if (std::max(texture.width, texture.height) > kLargestTextureSide || texture.width == 0 || texture.height == 0) {
    throw InputError("{}: {}x{} texels; a texture has from 1 to {} a side", where, texture.width, texture.height,
                     kLargestTextureSide);
  }
  bool black = true;
  for (std::size_t i = 0; i < texture.texels.size(); ++i) {
    const glm::vec3& texel = texture.texels[i];
    for (int c = 0; c < 3; ++c) {
      if (std::isfinite(texel[c]) && texel[c] >= 0) continue;
      throw InputError("{}: texel ({}, {}) from the top left is ({}, {}, {}); expected finite numbers from 0 up", where,
                       i % texture.width, i / texture.width, texel.r, texel.g, texel.b);
    }
    black = black && texel == glm::vec3(0);
  }
  if (black) throw InputError("{}: every texel is black; a light needs one at least that emits", where);
}

void write_texture(const Texture& texture, const std::filesystem::path& file) {
  ExrImage image;
  image.width = texture.width;
  image.height = texture.height;
  const float* first = &texture.texels.front().x;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::span<const float> values(first + c, 3 * texture.texels.size() - c);
    image.channels.push_back({std::string(1, "RGB"[c]), values, 3});
  }
  write_exr(file, image);
}

glm::dvec3 mean_color(const Texture& texture) {
  glm::dvec3 sum(0);
  for (const glm::vec3& texel : texture.texels) sum += glm::dvec3(texel);
  return sum / static_cast<double>(texture.texels.size());
}

}  // namespace penumbra::scenes
