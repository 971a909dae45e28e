// One struct, two languages: what look-ups of whole windows need of a light and its receivers.
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
  vec2 half_box;        // half the sides of the box that stands for the light, along the basis's u and v
  float smallest_near;  // no near plane is put nearer to the light than this
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
#endif  // PENUMBRA_MAPS_MAP_FRAME
