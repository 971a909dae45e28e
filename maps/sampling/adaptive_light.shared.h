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
};

struct AdaptivePush {
  uint filter_taps;  // 1: percentage-closer filter of 2 x 2 texels; 0: the receiver's own texel
  uint last;         // of the buffers of maps
  float total;       // of all weights, summed in the order of points
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
