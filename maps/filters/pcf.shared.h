// One struct, two languages: what pcf.comp has behind LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct PcfPush {
  uint window;  // texels on a side
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
