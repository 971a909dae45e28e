// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace penumbra::maps {

/// Number of points of the light used by horizon.glsl to estimate the fraction above a receiver's horizon.
inline constexpr std::uint32_t kHorizonSamples = 64;

}  // namespace penumbra::maps
