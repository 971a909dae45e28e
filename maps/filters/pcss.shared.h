// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of pcss.comp after LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct PcssPush {
  uint blocker_samples;  // number of taps of the blocker search, the first of the pattern
  uint filter_samples;   // number of taps of the filter, the next of the pattern
  float smallest_near;   // smallest distance of a near plane from the light
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
