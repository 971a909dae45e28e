// One struct, two languages: what bitmask.comp has behind LookupPush.
#ifdef __cplusplus
#pragma once
#include "maps/backprojection/fill.shared.h"
namespace penumbra::maps::gpu {
inline constexpr uint kOccluderPatch = 0, kOccluderQuad = 1, kOccluderTriangle = 2, kOccluderRect = 3;
#else
#include "maps/backprojection/fill.shared.h"
const uint kOccluderPatch = 0, kOccluderQuad = 1, kOccluderTriangle = 2, kOccluderRect = 3;
#endif

struct BitmaskPush {
  uint occluder;  // kOccluderPatch ...
  uint fill;      // kFillNone ...
  uint layers;    // that are asked
  uint level;     // of the maps
  uint search;    // whether a pyramid is asked
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
