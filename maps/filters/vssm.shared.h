// One struct, two languages: what vssm.comp has behind LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
/// csm: how much of half the period of its series heights span. The sum of n sines of a step has its last maximum 1 /
/// 2n of that before it jumps back: there, and not on the jump, is the shadow of the nearest caster on the deepest
/// receiver.
constexpr float fourier_span(uint terms) {
  return 1.0F - 0.5F / static_cast<float>(terms);
}
#else
float fourier_span(uint terms) {
  return 1.0 - 0.5 / float(terms);
}
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
