#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"
#include "volumes/counters/depth_counters.hpp"

#include <cstdint>
#include <memory>

namespace penumbra::volumes {

/// variant=forest of `depth-complexity` (Forest, Barthe, Paulin 2008): at most 16 light samples, a packed counter each;
/// silhouettes are those that the light's centre c sees, whose wedges are rasterised; hard shadow volumes of c give the
/// constant. docs/depth-complexity.md.
///
/// A counter is Σ σ_T over the triangles T that p→l meets, σ_T = 1 where p and c are on opposite sides of T, −1 where
/// they are on the same side, 0 where c is on its plane. So what it calls blocked is blocked; it may only be too
/// bright, and only where p→l meets a triangle whose plane passes through c or between c and l.
///
/// `counter_bits`: 6, 8 or 16. Where counters may have overflowed, and where signs are in doubt, pairs are decided
/// exactly; `as_published`: there counters say what they say, polluted by what left a neighbour's bits. read_counters
/// knows only counters of light samples above the horizon.
std::unique_ptr<DepthCounters> make_packed_counters(const render::Device& device, std::uint32_t counter_bits,
                                                    bool as_published = false);

}  // namespace penumbra::volumes
