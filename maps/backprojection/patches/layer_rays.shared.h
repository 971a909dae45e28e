// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of layer_rays.comp after LookupPush.
#ifdef __cplusplus
#pragma once
#include "maps/host/map_view.shared.h"
namespace penumbra::maps::gpu {
#endif

#ifdef __cplusplus
inline constexpr uint kMostLayers = 16;
#else
const uint kMostLayers = 16;
#endif

struct LayerRaysPush {
  uint layers;  // number of layers in use
  float gap;    // surfaces of neighbouring texels are joined up to this many texels' widths in depth
  uint solid;   // 1: the space between the first and the second layer, the third and the fourth ... is full
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
