// One struct, two languages: what deep_penumbra.comp has behind LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct DeepPenumbraPush {
  uint sample_count;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
