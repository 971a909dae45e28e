// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of width_map.comp.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct WidthMapPush {
  vec2 texel;  // of the face
  uint size;
  uint first;   // first texel of the face
  uint radius;  // search radius in texels
  uint down;    // 0: along rows, from black and white; 1: down columns, from the result of rows
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
