// One struct, two languages: what bitmask.comp has behind LookupPush.
#ifdef __cplusplus
#pragma once
#include "maps/backprojection/patches/fill.shared.h"
namespace penumbra::maps::gpu {
inline constexpr uint kOccluderPatch = 0, kOccluderQuad = 1, kOccluderTriangle = 2, kOccluderRect = 3;
inline constexpr uint kCoarsestLevel = 6;
#else
#include "maps/backprojection/patches/fill.shared.h"
const uint kOccluderPatch = 0, kOccluderQuad = 1, kOccluderTriangle = 2, kOccluderRect = 3;
const uint kCoarsestLevel = 6;
#endif

struct BitmaskPush {
  uint occluder;  // kOccluderPatch ...
  uint fill;      // kFillNone ...
  uint layers;    // that are asked
  uint level;     // of the maps; with a budget the finest
  uint search;    // whether a pyramid is asked
  uint budget;    // texels that a receiver looks at; 0: as many as there are
  uint blend;     // 1: between two levels samples are shared out
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
