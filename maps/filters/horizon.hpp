#pragma once

#include <cstdint>

namespace penumbra::maps {

/// Points of the light that say how much of it is above a receiver's horizon: horizon.glsl's.
inline constexpr std::uint32_t kHorizonSamples = 64;

}  // namespace penumbra::maps
