// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of backproject.comp after LookupPush.
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
  uint layers;   // number of layers in use
  uint ball;     // 1: the light is a sphere
  float radius;  // radius of the sphere, or of the disk of the light's area
  uint level;    // level of the maps; with a budget, the finest level
  uint budget;   // number of texels of a receiver's kernel
  uint blend;    // with a budget, 1: V between two levels is a blend of both levels' V
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
