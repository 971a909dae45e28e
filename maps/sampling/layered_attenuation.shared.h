// One struct, two languages: what layered_attenuation.comp has behind LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct AttenuationPush {
  uint sample_count;
  uint neighbours;  // 1: asks the texels around when the receiver's own knows nothing of it
  float epsilon;
  float total;  // weight of all samples
  uint layers;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
