// One struct, two languages (scalar layout): what the silhouette passes read and write.
#ifdef __cplusplus
#pragma once
#include "volumes/edges/device/facing.shared.h"

#include <cstdint>
namespace penumbra::volumes::gpu {
using uint = std::uint32_t;
#endif

/// Bits 0 and 1 of a triangle's word: is the light in front of it, behind it (neither: on its plane, or no area)? Bits
/// 2 and 3: the same if it counts so seen (ShadowCasters::counted_sides), else 0.
const uint kFrontBit = 1u, kBackBit = 2u, kBothBits = 3u, kCountedShift = 2u;

/// An edge's triangles as the device reads them, triangle · 2, + 1 if it runs from b to a: two of them, where there is
/// but one the other is a triangle that nothing counts of; or, with this bit, the edge's number among those with more.
const uint kManyIncidences = 1u << 31;

/// A triangle that floats cannot decide; in `side`, the host's answer.
struct OpenFacing {
  uint triangle;
  uint side;
};

/// An edge with k_e ≠ 0.
struct Silhouette {
  uint edge;
  int multiplicity;
};

struct SilhouetteFacingPush {
  FacingPoint light;
  uint triangle_count;
};

const uint kEdgesPerBlock = 32u;  // whose silhouettes are counted together, and written by one lane
/// Each adds up a stretch of the blocks. A device that stops loops at 2¹⁶ turns can take 5 · 10⁸ edges.
const uint kScanLanes = 256u;

#ifdef __cplusplus
}  // namespace penumbra::volumes::gpu
#endif
