// The functions of prefilter.shared.h. `t`: the texel's height in [0, 1], or of kBit the bit itself.
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

// Height in [0, 1] between the nearest caster and the deepest receiver of a side. Both ends are put a little apart, so
// that a single plane has a range, too.
float normalised_height(float height, float nearest, float deepest) {
  const float apart = 1.0 / 1024.0;
  const float low = nearest * (1.0 - apart), high = max(deepest, nearest) * (1.0 + apart);
  return clamp((height - low) / (high - low), 0.0, 1.0);
}
