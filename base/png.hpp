#pragma once

#include "base/image.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

/// The picture as a PNG file in memory: 8-bit RGB, marked as sRGB, no date: the same picture gives the same bytes.
/// A picture that PNG cannot hold (no pixels, or a side over a million) is a ResourceError.
std::vector<std::byte> encode_png(const Image8& image);
/// The same pixels in a third of the time, and some more bytes.
std::vector<std::byte> encode_png_fast(const Image8& image);
/// With alpha, which multiplies nothing: decode_rgba_png gives the same texels.
std::vector<std::byte> encode_rgba_png(const RgbaImage& image);

/// Writes it whole or not at all.
void write_png(const std::filesystem::path& path, const Image8& image);

/// "data:image/png;base64,…", to stand in the src of an HTML picture.
std::string png_data_uri(const Image8& image);

/// Any PNG picture in 8 bits, those of 16 rounded to the nearest, with its alpha (255 where it has none); values as the
/// file has them, whatever a gAMA or iCCP chunk says. InputError for what is no PNG file, is damaged, or has a side of
/// more than `largest_side` pixels, which is found out before anything is decoded.
RgbaImage decode_rgba_png(std::span<const std::byte> bytes, std::uint32_t largest_side);

/// Any PNG picture (1 to 16 bits, grey, colour or palette) in linear light, no digit lost: values are taken as sRGB
/// whatever a gAMA or iCCP chunk says, and transparent pixels are put on black. InputError for what is no PNG file, is
/// damaged, or has a side of more than `largest_side` pixels, which is found out before anything is decoded.
LinearImage decode_linear_png(std::span<const std::byte> bytes, std::uint32_t largest_side);

}  // namespace penumbra
