#pragma once

#include "base/image.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

/// The picture as a PNG file in memory: 8-bit RGB, marked as sRGB, no date: the same picture gives the same bytes.
/// A picture that PNG cannot hold (no pixels, or a side over a million) is a ResourceError.
std::vector<std::byte> encode_png(const Image8& image);

/// Writes it whole or not at all.
void write_png(const std::filesystem::path& path, const Image8& image);

/// "data:image/png;base64,…", to stand in the src of an HTML picture.
std::string png_data_uri(const Image8& image);

/// Throws InputError for what is no PNG file. Transparent pixels are put on black.
Image8 decode_png(std::span<const std::byte> bytes);

}  // namespace penumbra
