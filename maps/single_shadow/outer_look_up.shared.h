// One struct, two languages: what outer_look_up.comp has behind LookupPush.
#include "maps/single_shadow/falloff.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct OuterLookUpPush {
  uint falloff;    // kFalloffLinear ...
  uint linear;     // 1: between the four nearest texels
  uint smoothies;  // 1: penumbra begins behind what is drawn in the second map
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
