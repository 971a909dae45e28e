// One struct, two languages: what backproject_peel.comp has behind LookupPush.
#ifdef __cplusplus
#pragma once
#include "maps/backprojection/patches/fill.shared.h"
namespace penumbra::maps::gpu {
#else
#include "maps/backprojection/patches/fill.shared.h"  // fill.glsl's
#endif

struct PeelLookPush {
  uint layers;   // that are asked
  uint samples;  // texels a receiver at most; 0: all
  uint deepest;  // 1: of a texel's surfaces the deepest in front of the receiver counts, even if it misses the light
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
