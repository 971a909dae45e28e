// SPDX-License-Identifier: Apache-2.0
// Functions of prefilter.shared.h. `t`: the texel's height in [0, 1], or for kBit the bit itself.
#include "maps/products/map_frame.shared.h"
#include "maps/products/prefilter.shared.h"

float prefilter_value(PrefilterValue value, float t) {
  switch (value.kind) {
    case kLayer: {
      const float x = clamp(value.a * t - value.b, 0.0, 1.0);
      return value.power == kSquared ? (x - 0.5) * (x - 0.5) : x;
    }
    case kRising:
      return exp((value.power == kSquared ? 2.0 : 1.0) * value.a * (t - 1.0));
    case kFalling:
      return exp((value.power == kSquared ? -2.0 : -1.0) * value.a * t);
    case kSine:
      return 0.5 + 0.5 * sin(value.a * t) * (value.power == kTimesHeight ? t : 1.0);
    case kCosine:
      return 0.5 + 0.5 * cos(value.a * t) * (value.power == kTimesHeight ? t : 1.0);
    default:
      return t;
  }
}

// Returns the heights mapped to 0 and 1. The first is slightly less than that of the nearest caster, so that a single
// plane has a range, too. The second is exactly that of the deepest receiver: the value of a texel without a caster is
// no farther than this receiver. With a larger value, an exponential would count the texel as more than lit.
vec2 height_ends(float nearest, float deepest) {
  return vec2(nearest * (1.0 - 1.0 / 1024.0), max(deepest, nearest));
}

// Returns a height relative to height_ends(), in [0, 1].
float normalised_height(float height, float nearest, float deepest) {
  const vec2 ends = height_ends(nearest, deepest);
  return clamp((height - ends.x) / (ends.y - ends.x), 0.0, 1.0);
}
