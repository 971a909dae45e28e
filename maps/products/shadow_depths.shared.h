// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: value of a texel of two layers, for methods that filter or sort depths.
#ifndef PENUMBRA_MAPS_SHADOW_DEPTHS
#define PENUMBRA_MAPS_SHADOW_DEPTHS
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct ShadowDepthsPush {
  uint size;
  uint faces;
  uint depth_use;  // kDepthSecond ...
  float bias;      // in texels, as applied to receivers
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
#endif  // PENUMBRA_MAPS_SHADOW_DEPTHS
