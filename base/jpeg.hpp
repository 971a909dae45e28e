#pragma once

#include "base/image.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra {

/// Do the bytes begin as a JPEG file's?
bool looks_like_jpeg(std::span<const std::byte> bytes);

/// A JPEG picture in 8 bits, alpha 255, as libjpeg decodes it by its defaults. InputError for what is no JPEG file, is
/// damaged, has colours that are neither grey nor RGB (CMYK), or has a side of more than `largest_side` pixels, which
/// is found out before anything is decoded.
RgbaImage decode_rgba_jpeg(std::span<const std::byte> bytes, std::uint32_t largest_side);

/// The picture as a JPEG file in memory, without loss of colour's resolution, for eyes; `quality` from 1 to 100. A
/// picture that JPEG cannot hold (no pixels, or a side over 65,500) is a ResourceError.
std::vector<std::byte> encode_jpeg(const Image8& image, int quality);

}  // namespace penumbra
