// SPDX-License-Identifier: Apache-2.0
// Reads pictures of lights (PNG, OpenEXR) and of skies (also Radiance). The first bytes tell the format; the file's
// length and the picture's side are limited before decoding.

#include "import/texture_file.hpp"

#include "base/error.hpp"
#include "base/exr.hpp"
#include "base/png.hpp"
#include "base/rgbe.hpp"

#include <sys/stat.h>

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace penumbra::import {
namespace {

constexpr std::array kPngMark = {std::byte{0x89}, std::byte{'P'}, std::byte{'N'}, std::byte{'G'}};
constexpr std::array kExrMark = {std::byte{0x76}, std::byte{0x2f}, std::byte{0x31}, std::byte{0x01}};
/// Size of the largest accepted picture, uncompressed, with four 32-bit channels, and room for other content of a file.
constexpr std::uintmax_t kMostBytes = std::uintmax_t{128} << 20, kMostSkyBytes = std::uintmax_t{640} << 20;

std::string read_bytes(const mesh::InputFile& input, std::uintmax_t most_bytes) {
  struct stat info {};
  const bool known = ::fstat(input.content.get(), &info) == 0;
  if (known && static_cast<std::uintmax_t>(info.st_size) > most_bytes) {
    throw InputError("{} bytes; a picture's file has at most {}", info.st_size, most_bytes);
  }
  return mesh::read_content(input.content.get(), input.name.string());
}

template <std::size_t kSize>
bool begins_with(std::span<const std::byte> bytes, const std::array<std::byte, kSize>& mark) {
  return bytes.size() >= kSize && std::ranges::equal(bytes.first(kSize), mark);
}

std::string list_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 16;
  const std::span<const std::string> first = std::span(names).first(std::min(names.size(), kMost));
  return fmt::format("{}{}", fmt::join(first, ", "), names.size() > kMost ? ", and others" : "");
}

LinearImage read_exr_picture(std::span<const std::byte> bytes, const std::string& shown, std::uint32_t largest_side) {
  // Reads only the used channels: a file may have thousands, of 16 MiB each in memory.
  const ExrFile exr = read_exr(bytes, shown, {.largest_side = largest_side, .channels = {"R", "G", "B", "Y"}});
  const std::array<const char*, 3> names =
      exr.floats.contains("Y") && !exr.floats.contains("R") ? std::array{"Y", "Y", "Y"} : std::array{"R", "G", "B"};
  std::array<const std::vector<float>*, 3> channels{};
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const auto found = exr.floats.find(names[c]);
    if (found == exr.floats.end()) {
      throw InputError("no channel {} of floats; a texture has R, G and B, or Y alone; this file has: {}", names[c],
                       list_of(exr.channel_names));
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

}  // namespace

scenes::Texture read_texture_file(const mesh::InputFile& input) {
  const std::string content = read_bytes(input, kMostBytes);
  const std::span<const std::byte> bytes = std::as_bytes(std::span(content));
  const bool is_png = begins_with(bytes, kPngMark);
  if (!is_png && !begins_with(bytes, kExrMark)) {
    throw InputError("it is neither a PNG nor an OpenEXR picture; a texture is one of the two");
  }
  LinearImage image = is_png ? decode_linear_png(bytes, scenes::kLargestTextureSide)
                             : read_exr_picture(bytes, input.name.string(), scenes::kLargestTextureSide);
  return {{}, image.width, image.height, std::move(image.pixels)};
}

scenes::Texture read_sky_file(const mesh::InputFile& input) {
  const std::string content = read_bytes(input, kMostSkyBytes);
  const std::span<const std::byte> bytes = std::as_bytes(std::span(content));
  const bool is_png = begins_with(bytes, kPngMark), is_exr = begins_with(bytes, kExrMark);
  if (!is_png && !is_exr && !is_rgbe(bytes))
    throw InputError("it is no Radiance (.hdr), OpenEXR or PNG picture; the picture of a dome is one of these");
  LinearImage image = is_png   ? decode_linear_png(bytes, scenes::kLargestSkySide)
                      : is_exr ? read_exr_picture(bytes, input.name.string(), scenes::kLargestSkySide)
                               : decode_rgbe(bytes, scenes::kLargestSkySide);
  return {{}, image.width, image.height, std::move(image.pixels)};
}

}  // namespace penumbra::import
