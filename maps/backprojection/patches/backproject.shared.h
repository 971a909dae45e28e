// One struct, two languages: what backproject.comp has behind LookupPush.
#ifdef __cplusplus
#pragma once
#include "maps/backprojection/patches/fill.shared.h"
namespace penumbra::maps::gpu {
inline constexpr uint kFormPatch = 0, kFormSphere = 1;
#else
#include "maps/backprojection/patches/fill.shared.h"
const uint kFormPatch = 0, kFormSphere = 1;
#endif

struct BackprojectPush {
  uint layers;   // that are asked
  uint ball;     // 1: the light is a sphere
  float radius;  // its, or that of the disk of the light's area
  uint level;    // of the maps; with a budget the finest
  uint budget;   // texels that a receiver looks at
  uint blend;    // with a budget, 1: between two levels V is between theirs
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
