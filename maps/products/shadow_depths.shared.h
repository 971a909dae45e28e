// One struct, two languages: what a texel of two layers is made into, where a method filters depths or sorts them.
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
  float bias;      // in texels, that receivers will be given
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
#endif  // PENUMBRA_MAPS_SHADOW_DEPTHS
