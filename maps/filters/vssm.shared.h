// One struct, two languages: what vssm.comp has behind LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

// What stands for the distribution of heights in a window: specialization constant 1.
const uint kVariance = 0;     // vsm, lvsm: mean and mean square, of each layer its own
const uint kExpVariance = 1;  // evsm: of a rising and a falling exponential
const uint kFourier = 2;      // csm
const uint kExponential = 3;  // esm

struct VssmPush {
  uint count;      // layers of kVariance, terms of kFourier
  float exponent;  // of exponentials
  float scale;     // csm: the step is made so much steeper
  float leak;      // V below this is black
  uint fallback;   // esm: compare texel by texel where the exponential says more than 1
  uint horizon_samples;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
