// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: head of LightSampleBands' buffer.
#ifdef __cplusplus
#pragma once
#include "maps/host/map_view.shared.h"
namespace penumbra::maps::gpu {
#endif

// Light samples in the light's basis. Followed by words: x and y of each sample in the samples' order; for each band of
// y the sorted index of its first sample, and finally the number of samples; then, sorted by band and within a band by
// x, for each sample x, y and its index. Band k holds floor((y - lower) * per_unit) = k.
struct SampleBandsHead {
  uint samples, bands;
  float lower, per_unit;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
