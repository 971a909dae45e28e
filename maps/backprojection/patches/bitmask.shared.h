// One struct and constants, two languages: what bitmask.comp has behind LookupPush.
#ifdef __cplusplus
#pragma once
#include "maps/backprojection/patches/fill.shared.h"
namespace penumbra::maps::gpu {
inline constexpr uint kOccluderPatch = 0, kOccluderQuad = 1, kOccluderTriangle = 2, kOccluderRect = 3;
inline constexpr uint kFinestLevel = 0, kOneLevel = 1, kLevelsByBudget = 2;
inline constexpr uint kCoarsestLevel = 6;
#else
#include "maps/backprojection/patches/fill.shared.h"
const uint kOccluderPatch = 0, kOccluderQuad = 1, kOccluderTriangle = 2, kOccluderRect = 3;
// Which levels are looked at: the maps themselves, one that is coarser, or what a budget says.
const uint kFinestLevel = 0, kOneLevel = 1, kLevelsByBudget = 2;
const uint kCoarsestLevel = 6;
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
