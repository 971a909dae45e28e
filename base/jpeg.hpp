// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/image.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra {

/// Returns whether the bytes begin as a JPEG file does.
bool looks_like_jpeg(std::span<const std::byte> bytes);

/// Decodes a JPEG picture to 8 bits, alpha 255, with libjpeg's defaults. CMYK and YCCK become RGB without a colour
/// profile; with Adobe's marker their values are inverted. Throws InputError for bytes that are not a
/// JPEG file, are damaged, or have a side of more than `largest_side` pixels, which is checked before anything is
/// decoded.
RgbaImage decode_rgba_jpeg(std::span<const std::byte> bytes, std::uint32_t largest_side);

/// Returns the picture as a JPEG file in memory, with colours at full resolution, for display; `quality` from 1 to 100.
/// Throws ResourceError for a picture that JPEG cannot hold (no pixels, or a side over 65,500).
std::vector<std::byte> encode_jpeg(const Image8& image, int quality);

}  // namespace penumbra
