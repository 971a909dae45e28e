// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::visibility {

/// Rows and columns of a request. Every pattern but sobol has rows; rows, grid and rgss round the count.
struct SampleLayout {
  std::uint32_t count = 0;    ///< number of points that the pattern gives
  std::uint32_t rows = 0;     ///< rgss: rows of squares of four points
  std::uint32_t columns = 0;  ///< rows and grid: points in each row; rgss: squares
};

/// Throws UsageError for a count outside 1 … kMaxLightSamples.
SampleLayout layout_of(const SampleRequest& request);

/// Returns the shift of a row in cells for the rows pattern, in (−0.5, 0.5); row 0 is not shifted. A multiple of 2⁻¹⁶,
/// so exact in float and double.
double row_shift_of(std::uint32_t row);

inline constexpr std::uint32_t kMaxLightSamples = 4096;

/// SplitMix64's finaliser: every input bit affects every output bit.
constexpr std::uint32_t hash(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  std::uint64_t x = (static_cast<std::uint64_t>(a) << 32 | b) + 0x9e3779b97f4a7c15ull * (c + 1ull);
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return static_cast<std::uint32_t>((x ^ (x >> 31)) >> 32);
}

/// Converts to double exactly, in [0, 1).
constexpr double to_unit(std::uint32_t bits) {
  return static_cast<double>(bits) * 0x1p-32;
}

}  // namespace penumbra::visibility
