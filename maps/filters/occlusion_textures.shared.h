// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of occlusion_textures.comp after LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct OcclusionPush {
  uint horizon_samples;  // number of the pattern's points used for the horizon
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
