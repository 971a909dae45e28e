// How much light there is a share t of the way through a penumbra, from where it is dark to where it is lit. Parker et al.
// 1998: what a straight edge leaves of a round light is (1 + sin(pi t - pi/2)) / 2, or nearly 3 t^2 - 2 t^3; of a rectangle
// along whose side the edge lies it is t.
#include "maps/single_shadow/falloff.shared.h"

float light_at(uint falloff, float t) {
  t = clamp(t, 0.0, 1.0);
  if (falloff == kFalloffCubic) return t * t * (3.0 - 2.0 * t);
  if (falloff == kFalloffSine) return 0.5 - 0.5 * cos(3.1415927 * t);
  return t;
}
