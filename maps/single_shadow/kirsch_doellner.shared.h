// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of kirsch_doellner.comp after LookupPush.
#include "maps/single_shadow/falloff.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct KirschDoellnerPush {
  uint falloff;  // kFalloffLinear ...
  float light;   // the light's radius
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
