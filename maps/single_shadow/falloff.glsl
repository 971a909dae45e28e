// SPDX-License-Identifier: Apache-2.0
// Fraction of light at the fraction t of a penumbra's width, from dark to lit. Parker et al. 1998: for a round light
// behind a straight edge it is (1 + sin(pi t - pi/2)) / 2, or nearly 3 t^2 - 2 t^3; for a rectangle with a side
// parallel to the edge it is t.
#include "maps/single_shadow/falloff.shared.h"

float light_at(uint falloff, float t) {
  t = clamp(t, 0.0, 1.0);
  if (falloff == kFalloffCubic) return t * t * (3.0 - 2.0 * t);
  if (falloff == kFalloffSine) return 0.5 - 0.5 * cos(3.1415927 * t);
  return t;
}
