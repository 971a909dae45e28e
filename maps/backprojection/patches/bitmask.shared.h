// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: constants, and push constants of bitmask.comp after LookupPush.
#ifdef __cplusplus
#pragma once
#include "maps/backprojection/patches/fill.shared.h"
namespace penumbra::maps::gpu {
inline constexpr uint kOccluderPatch = 0, kOccluderQuad = 1, kOccluderTriangle = 2, kOccluderRect = 3;
#else
#include "maps/backprojection/patches/fill.shared.h"
const uint kOccluderPatch = 0, kOccluderQuad = 1, kOccluderTriangle = 2, kOccluderRect = 3;
#endif

struct BitmaskPush {
  uint layers;  // number of layers in use
  uint level;   // level of the maps; with a budget, the finest level
  uint budget;  // number of texels of a receiver's kernel
  uint blend;   // with a budget, 1: between two levels, samples are divided among both
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
