// One struct and constants, two languages: what bitmask.comp has behind LookupPush.
#ifdef __cplusplus
#pragma once
#include "maps/backprojection/patches/fill.shared.h"
namespace penumbra::maps::gpu {
inline constexpr uint kOccluderPatch = 0, kOccluderQuad = 1, kOccluderTriangle = 2, kOccluderRect = 3;
#else
#include "maps/backprojection/patches/fill.shared.h"
const uint kOccluderPatch = 0, kOccluderQuad = 1, kOccluderTriangle = 2, kOccluderRect = 3;
#endif

struct BitmaskPush {
  uint layers;  // that are asked
  uint level;   // of the maps; with a budget the finest
  uint budget;  // texels that a receiver looks at
  uint blend;   // with a budget, 1: between two levels samples are shared out
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
