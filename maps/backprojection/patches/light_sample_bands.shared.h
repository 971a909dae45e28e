// One struct, two languages: what LightSampleBands' buffer begins with.
#ifdef __cplusplus
#pragma once
#include "maps/host/map_view.shared.h"
namespace penumbra::maps::gpu {
#endif

// The light samples in the light's basis. Behind it, as words: x and y of each sample in its order; for each band of y
// the number of its first sample among those sorted, and once more the number of all; then, sorted by band and in it by
// x, for each sample x, y and which it is. Band k holds floor((y - lower) * per_unit) = k.
struct SampleBandsHead {
  uint samples, bands;
  float lower, per_unit;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
