// SPDX-License-Identifier: Apache-2.0
#include "maps/filters/pcss.shared.h"
#define OWN_PUSH PcssPush
#include "maps/host/look_up.glsl"

// Percentage-closer soft shadows (Fernando 2005), in the light's basis: centre at 0, scene at z > 0. The ray from a
// receiver p to the light point s passes height z at p z/p.z + s (1 - z/p.z): on the map (x/z, y/z), the light as seen
// through height z is an image of the light's own shape, scaled by 1/z - 1/p.z, around the receiver. So both windows
// have the light's shape, and this scale is equivalent to Fernando's width of the penumbra over the receiver, w (p.z -
// z)/z.

layout(scalar, binding = FIRST_PRODUCT) readonly buffer Nearest { float nearest[2]; };
// light points in the light's basis, and their weights
layout(scalar, binding = FIRST_PRODUCT + 1) readonly buffer Taps { vec3 taps[]; };

// Returns the map's tap at the light point s seen through height z; see above.
Tap tap_at(LightView view, vec3 d, vec2 s, float z) {
  const float height = abs(d.z);
  const vec2 at = d.xy / height + s * (1.0 / z - 1.0 / height);
  return fetch(view, 0, lookup.size, vec3(at * height, d.z));
}

float visibility_of(LightView view, vec3 d, vec3 m) {
  const float height = abs(d.z);

  // Step 1: blockers in the light–receiver pyramid at the near plane.
  const float near = min(max(nearest[d.z < 0.0 ? 1 : 0], own.smallest_near), height);
  float sum = 0.0;
  uint blockers = 0;
  for (uint k = 0; k < own.blocker_samples; ++k) {
    const Tap tap = tap_at(view, d, taps[k].xy, near);
    if (blocks_light(tap, d, m, lookup.bias)) {
      sum += tap.depth * abs(tap.direction.z);
      ++blockers;
    }
  }

  // Steps 2 and 3: all blockers are replaced by one plane at their mean height, and V is the fraction of the light seen
  // past this plane. A light point below the receiver's horizon is hidden, independent of the map.
  const float blocker = blockers == 0 ? height : sum / float(blockers);
  float visible = 0.0, total = 0.0;  // integers without a texture
  for (uint k = 0; k < own.filter_samples; ++k) {
    const vec2 s = taps[own.blocker_samples + k].xy;
    const float weight = taps[own.blocker_samples + k].z;
    total += weight;
    const bool above = dot(m, d - vec3(s, 0.0)) > 0.0;
    if (above && (blockers == 0 || !blocks_light(tap_at(view, d, s, blocker), d, m, lookup.bias))) visible += weight;
  }
  return visible / total;
}

#include "maps/host/scalar_main.glsl"
