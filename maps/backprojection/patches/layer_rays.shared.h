// One struct, two languages: what layer_rays.comp has behind LookupPush.
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
  uint layers;  // that are asked
  float gap;    // surfaces of neighbouring texels are joined up to this many texels' widths in depth
  uint solid;   // 1: what is between the first and the second layer, the third and the fourth ... is full
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
