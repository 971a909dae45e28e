// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of vssm.comp after LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
/// Returns, for csm, the fraction of half the period of its series spanned by heights. The sum of n sines of a step has
/// its last maximum 1 / 2n of half the period before the jump back: the farthest texel behind the nearest receiver is
/// placed there, not on the jump. The step's offset, in lobes of the same width, moves this texel, and the shadow of
/// the nearest caster on the deepest receiver, nearer to the jump.
constexpr float fourier_span(uint terms, float offset) {
  const float span = 1.0F - 0.5F * (1.0F + offset) / static_cast<float>(terms);
  return span > 0.5F ? span : 0.5F;
}
#else
float fourier_span(uint terms, float offset) {
  return max(1.0 - 0.5 * (1.0 + offset) / float(terms), 0.5);
}
#endif

// Model of the distribution of heights in a window: specialization constant 1.
const uint kVariance = 0;     // vsm, lvsm: mean and mean square, for each layer
const uint kExpVariance = 1;  // evsm: mean and mean square of a rising and a falling exponential
const uint kFourier = 2;      // csm
const uint kExponential = 3;  // esm

// Subdivision of a window into parts: specialization constant 4.
const uint kUniform = 0;   // cuts into the smallest parts, wherever something in the window is nearer than the receiver
const uint kAdaptive = 1;  // cuts into four where the mean is not nearer than the receiver, recursively

struct VssmPush {
  uint count;      // number of layers of kVariance, or of terms of kFourier
  float exponent;  // exponent of the exponentials
  float scale;     // csm: factor of the step's slope
  float leak;      // a smaller V is black
  uint fallback;   // esm, 1: compares texel by texel where the exponential is above 1
  uint horizon_samples;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
