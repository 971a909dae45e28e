// One struct, two languages: width_map.comp's.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct WidthMapPush {
  vec2 texel;  // of the face
  uint size;
  uint first;   // texel of the face
  uint radius;  // texels, how far is looked
  uint down;    // 0: along rows, from black and white; 1: down columns, from that
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
