// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: identity of a texel's nearest surface. nearest_ids.hpp describes it.
#ifndef PENUMBRA_MAPS_NEAREST_IDS
#define PENUMBRA_MAPS_NEAREST_IDS
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
inline constexpr uint kNoId = 0xffffffffu;
#else
const uint kNoId = 0xffffffffu;  // of an empty texel, and of receivers contained in no map
#endif

// Push constants of nearest_ids.vert, which reads the first part, and nearest_ids.frag.
struct IdsPush {
  CasterPush face;
  uint size;   // of a face
  uint first;  // first texel of the face
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
#endif  // PENUMBRA_MAPS_NEAREST_IDS
