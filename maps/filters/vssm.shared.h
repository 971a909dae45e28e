// One struct, two languages: what vssm.comp has behind LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
/// csm: how much of half the period of its series heights span. The sum of n sines of a step has its last maximum 1 /
/// 2n of that before it jumps back: there, and not on the jump, is the farthest texel behind the nearest receiver,
/// which the step's offset, in lobes of as much, moves nearer to the jump; and the shadow of the nearest caster on the
/// deepest receiver.
constexpr float fourier_span(uint terms, float offset) {
  const float span = 1.0F - 0.5F * (1.0F + offset) / static_cast<float>(terms);
  return span > 0.5F ? span : 0.5F;
}
#else
float fourier_span(uint terms, float offset) {
  return max(1.0 - 0.5 * (1.0 + offset) / float(terms), 0.5);
}
#endif

// What stands for the distribution of heights in a window: specialization constant 1.
const uint kVariance = 0;     // vsm, lvsm: mean and mean square, of each layer its own
const uint kExpVariance = 1;  // evsm: of a rising and a falling exponential
const uint kFourier = 2;      // csm
const uint kExponential = 3;  // esm

// How a window is cut into parts: specialization constant 4.
const uint kUniform = 0;   // in the smallest, wherever something in it is nearer than the receiver
const uint kAdaptive = 1;  // in four where the mean is not nearer than the receiver; these again

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
