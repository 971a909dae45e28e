// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of backproject_peel.comp after LookupPush.
#ifdef __cplusplus
#pragma once
#include "maps/backprojection/patches/fill.shared.h"
namespace penumbra::maps::gpu {
#else
#include "maps/backprojection/patches/fill.shared.h"  // constants of fill.glsl
#endif

struct PeelLookPush {
  uint layers;   // number of layers in use
  uint samples;  // largest number of texels for each receiver; 0: all
  uint deepest;  // 1: a texel's deepest surface in front of the receiver counts, even if this surface misses the light
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
