// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/image.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace penumbra {

/// Returns whether the bytes begin as a Radiance picture does.
bool is_rgbe(std::span<const std::byte> bytes);

/// Reads a Radiance picture (.hdr, 32-bit_rle_rgbe): a mantissa m and the shared exponent e are m 2^(e − 136), divided
/// by the header's exposures. The result starts at the top left, regardless of the direction of the file's scan lines.
/// Throws InputError, without the file's name, for anything else and for pictures larger than `largest_side`.
LinearImage decode_rgbe(std::span<const std::byte> bytes, std::uint32_t largest_side);

}  // namespace penumbra
