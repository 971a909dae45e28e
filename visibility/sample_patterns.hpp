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

}  // namespace penumbra::visibility
