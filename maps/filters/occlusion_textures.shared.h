// One struct, two languages: what occlusion_textures.comp has behind LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct OcclusionPush {
  uint horizon_samples;  // of the pattern's points
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
