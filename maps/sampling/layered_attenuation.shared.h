// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of layered_attenuation.comp after LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct AttenuationPush {
  uint sample_count;
  uint neighbours;  // 1: also searches the texels around if the receiver is not found in its own
  float epsilon;
  float total;  // weight of all samples
  uint layers;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
