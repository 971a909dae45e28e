// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: packing of counters of light samples (docs/depth-complexity.md, variant=forest).
#ifdef __cplusplus
#pragma once
#include <cstdint>
namespace penumbra::volumes::gpu {
using uint = std::uint32_t;
#endif

/// Largest number of light samples of a pass: as many as a word of a mask has bits.
const uint kMostPacked = 32;

/// A counter is a digit of `bits` bits, from the lowest on. A sum of digits d_j · 2^(bits · j) modulo 2⁶⁴, in any
/// order, determines each d_j as long as every |d_j| < 2^(bits − 1) at the end. The last word is the sum of |k_e| of
/// all edges that changed a counter: no |d_j| is larger.

/// Doubles before the light samples (packed_counters.frag).
const uint kPackedHead = 6;
/// Error relative to the terms of the sums X, Y and W, each of which has three roundings: 2⁻⁴⁶ is more than 2⁴ times
/// their error, so that the kept part of an edge is also longer than the rounding of its parameters.
const double kAppearError = 1.0 / 70368744177664.0;

#ifdef __cplusplus
}  // namespace penumbra::volumes::gpu
#endif
