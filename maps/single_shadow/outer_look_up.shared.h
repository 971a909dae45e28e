// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of outer_look_up.comp after LookupPush.
#include "maps/single_shadow/falloff.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct OuterLookUpPush {
  uint falloff;    // kFalloffLinear ...
  uint linear;     // 1: between the four nearest texels
  uint smoothies;  // 1: penumbra begins behind the surfaces drawn in the second map
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
