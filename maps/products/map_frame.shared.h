// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: data of a light and its receivers for look-ups of whole windows.
#ifndef PENUMBRA_MAPS_MAP_FRAME
#define PENUMBRA_MAPS_MAP_FRAME
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

// Heights are distances from the light's plane.
struct MapFrame {
  float deepest[2];     // height of the deepest receiver where the light's normal points, and behind; 0: there is none
  vec2 half_box;        // half the sides of the box that replaces the light, along the basis's u and v
  float smallest_near;  // smallest distance of a near plane from the light
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
#endif  // PENUMBRA_MAPS_MAP_FRAME
