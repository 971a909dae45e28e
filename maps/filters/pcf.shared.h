// One struct, two languages: what pcf.comp has behind LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct PcfPush {
  uint window;          // texels on a side
  uint receiver_plane;  // each texel is compared with the receiver's plane; else with the receiver's own depth
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
