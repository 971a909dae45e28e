// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of adaptive_compare.comp and adaptive_light.comp after LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct AdaptiveComparePush {
  uint view_a, view_b;  // indices among all light points
  uint map_a, map_b;    // first faces in their buffers
  uint counter;
  float gamma;
  uint of_range;  // 1: gamma is a fraction of the depth range of a map (equation 3); 0: of the compared heights
                  // (equation 7)
};

struct AdaptivePush {
  uint taps;    // percentage-closer filter of `taps` texels a side; 1: the receiver's own texel
  uint last;    // last of the buffers of maps
  float total;  // sum of all weights, in the order of points
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
