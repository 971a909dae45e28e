// One struct, two languages: what brabec_seidel.comp and parker.comp have behind LookupPush.
#include "maps/single_shadow/falloff.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct SearchPush {
  uint falloff;  // kFalloffLinear ...
  uint offsets;  // how many there are
  uint radius;   // none is longer, in texels
  float light;   // the light's radius
  uint ids;      // 1: what is of the receiver's own object shades nothing of it
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
