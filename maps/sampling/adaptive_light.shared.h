// Structs, two languages: what adaptive_compare.comp and adaptive_light.comp have behind LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct AdaptiveComparePush {
  uint view_a, view_b;  // among all light points
  uint map_a, map_b;    // in their buffers, in faces
  uint counter;
  float gamma;
  uint of_range;  // 1: gamma is a share of all depths of a map (equation 3); 0: of the heights compared (equation 7)
};

struct AdaptivePush {
  uint taps;    // percentage-closer filter of so many texels a side; 1: the receiver's own texel
  uint last;    // of the buffers of maps
  float total;  // of all weights, summed in the order of points
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
