// One struct, two languages: what pcss.comp has behind LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct PcssPush {
  uint blocker_samples;  // the first of the pattern's points
  uint filter_samples;   // those that follow
  float smallest_near;   // no near plane is put nearer to the light than this
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
