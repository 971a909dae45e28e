// One struct, two languages: nearest_caster.comp's.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct NearestPush {
  uint size;
  uint faces;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
