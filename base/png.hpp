// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/image.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

/// Returns the picture as a PNG file in memory: 8-bit RGB, marked as sRGB, no date: equal pictures give equal bytes.
/// Throws ResourceError for a picture that PNG cannot hold (no pixels, or a side over a million).
std::vector<std::byte> encode_png(const Image8& image);
/// Encodes the picture in a third of encode_png's time, with slightly more bytes.
std::vector<std::byte> encode_png_fast(const Image8& image);
/// Encodes a picture with straight (not premultiplied) alpha: decode_rgba_png returns equal texels.
std::vector<std::byte> encode_rgba_png(const RgbaImage& image);

/// Writes a PNG file whole or not at all.
void write_png(const std::filesystem::path& path, const Image8& image);

/// Returns "data:image/png;base64,…", for the src attribute of an HTML picture.
std::string png_data_uri(const Image8& image);

/// Decodes any PNG picture to 8 bits, with its alpha (255 if it has none); 16-bit values are rounded to the nearest.
/// Values are those of the file, regardless of gAMA and iCCP chunks. Throws InputError for bytes that are not a PNG
/// file, are damaged, or have a side of more than `largest_side` pixels, which is checked before anything is decoded.
RgbaImage decode_rgba_png(std::span<const std::byte> bytes, std::uint32_t largest_side);

/// Decodes any PNG picture (1 to 16 bits, grey, colour or palette) to linear light, without loss of precision: values
/// are taken as sRGB regardless of gAMA and iCCP chunks, and transparent pixels are composited on black. Throws
/// InputError for bytes that are not a PNG file, are damaged, or have a side of more than `largest_side` pixels, which
/// is checked before anything is decoded.
LinearImage decode_linear_png(std::span<const std::byte> bytes, std::uint32_t largest_side);

}  // namespace penumbra
