// One struct, two languages: which triangle a texel's nearest surface is of. nearest_ids.hpp has the picture.
#ifndef PENUMBRA_MAPS_NEAREST_IDS
#define PENUMBRA_MAPS_NEAREST_IDS
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
inline constexpr uint kNoId = 0xffffffffu;
#else
const uint kNoId = 0xffffffffu;  // of a texel that holds nothing, and of receivers that no map holds
#endif

// nearest_ids.vert, which reads the first part, and nearest_ids.frag.
struct IdsPush {
  CasterPush face;
  uint size;   // of a face
  uint first;  // texel of the face
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
#endif  // PENUMBRA_MAPS_NEAREST_IDS
