// SPDX-License-Identifier: Apache-2.0
// Test whether a surface with holes (MASK) is solid at a map texel's centre, by the nearest texel of the picture's
// level 0, consistent with visibility::alpha_at. Rasterisers interpolate linearly over the triangle as drawn. Corners
// therefore carry their values times a weight, and the weight itself, by which this shader divides: in a scene in
// projective coordinates, the weight is not the face's w.
#include "maps/host/holes.shared.h"

STORAGE(1) readonly buffer Places { uint places[]; };  // written by the vertex shader
STORAGE(2) readonly buffer Surfaces { uint surface_words[]; };
layout(location = 1) in vec4 place;
layout(location = 2) flat in uint surface;

uint texel_number(float texel, uint size, uint wrap) {
  const float count = float(size);
  if (wrap == kClampTexels) return uint(clamp(texel, 0.0, count - 1.0));
  const float period = wrap == kMirrorTexels ? 2.0 * count : count;
  float at = texel - period * floor(texel / period);
  if (at >= count) at = period - 1.0 - at;  // mirrored
  return uint(clamp(at, 0.0, count - 1.0));
}

bool is_hole() {
  const uint first = surface * kSurfaceWords;
  const uint width = surface_words[first + 1], height = surface_words[first + 2];
  const vec2 at = floor(place.xy / place.w * vec2(width, height));
  uint texel = 255;
  if (width != 0 && all(lessThan(abs(at), vec2(1e30)))) {
    const uint number = texel_number(at.y, height, surface_words[first + 4]) * width +
                        texel_number(at.x, width, surface_words[first + 3]);
    texel = surface_words[surface_words[first] + number / 4] >> 8 * (number % 4) & 255u;
  }
  return clamp(place.z / place.w, 0.0, 1.0) < uintBitsToFloat(surface_words[first + 5 + texel]);
}
