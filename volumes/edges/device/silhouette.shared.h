// SPDX-License-Identifier: Apache-2.0
// Structs shared by C++ and GLSL (scalar layout): data of the silhouette passes.
#ifdef __cplusplus
#pragma once
#include "volumes/edges/device/facing.shared.h"

#include <cstdint>
namespace penumbra::volumes::gpu {
using uint = std::uint32_t;
#endif

/// Bits 0 and 1 of a triangle's word: the light is in front of the triangle, or behind it (neither: on its plane, or
/// the triangle has no area). Bits 2 and 3: the same bits if the triangle counts for that side
/// (ShadowCasters::counted_sides), else 0.
const uint kFrontBit = 1u, kBackBit = 2u, kBothBits = 3u, kCountedShift = 2u;

/// The triangles of an edge are stored as a pair of words: each is 2 · triangle, + 1 if the triangle's winding runs
/// from b to a. If an edge has one triangle, the second word refers to a triangle that never counts. If it has more
/// than two, the first word has this bit, and its other bits are the edge's index among such edges, whose triangles are
/// in a list.
const uint kManyIncidences = 1u << 31;

/// A triangle that floats cannot decide; `side` receives the host's answer.
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

const uint kEdgesPerBlock = 32u;  // edges whose silhouettes are counted together, and written by one lane
/// Each lane adds up a range of the blocks. A device that stops loops at 2¹⁶ iterations can handle 5 · 10⁸ edges.
const uint kScanLanes = 256u;

#ifdef __cplusplus
}  // namespace penumbra::volumes::gpu
#endif
