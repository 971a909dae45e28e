// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of brabec_seidel.comp and parker.comp after LookupPush.
#include "maps/single_shadow/falloff.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct SearchPush {
  uint falloff;  // kFalloffLinear ...
  uint offsets;  // number of offsets
  uint radius;   // length of the longest offset, in texels
  float light;   // the light's radius
  uint ids;      // 1: surfaces of the receiver's own object do not shade the receiver
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
