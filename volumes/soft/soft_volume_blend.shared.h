// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: sums of one occluder's edges at one receiver, in 64-bit words.
#ifdef __cplusplus
#pragma once
#include <cstdint>
namespace penumbra::volumes::gpu {
using uint = std::uint32_t;
#endif

/// Words of each quarter q (bit 0: u < 0, bit 1: v < 0): its share; then 1 − the lower ends and the upper ends of the
/// box around its edges, so that 0 means empty. Shares and ends in units of kSumUnit.
const uint kQuarterWords = 5;
/// First word of the changes of the count between the centre and the points around it, at the edges crossed on the way.
/// The points are 45° apart, beginning at (1, 0).
const uint kPointWord = 4 * kQuarterWords;
const uint kPoints = 8;
const uint kBlendWords = kPointWord + kPoints;

#ifdef __cplusplus
}  // namespace penumbra::volumes::gpu
#endif
