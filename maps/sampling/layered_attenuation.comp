// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/products/lists/layered_depth.shared.h"
#include "maps/sampling/layered_attenuation.shared.h"
#define OWN_PUSH AttenuationPush
#include "maps/host/look_up.glsl"
#include "maps/sampling/texel.glsl"

// Searches for the receiver among its texel's surfaces (Agrawala, Ramamoorthi, Heirich and Moll 2000); V is the
// fraction of light samples that see the receiver, 0 if no sample does.

layout(scalar, binding = 4) readonly buffer Entries { LayerEntry entries[]; };
layout(scalar, binding = 5) readonly buffer Samples { vec3 samples[]; };
#include "maps/host/share_above.glsl"

// Returns the weight of the surface in this texel that contains the receiver's plane; 0 if there is none. The tolerance
// is epsilon, plus the bias, plus the change of the surface's own depth within the texel.
uint weight_in(Texel texel, vec3 m, float h) {
  if (texel.index == kNoTexel) return 0;
  float forgiven;
  const float plane = plane_depth(texel, m, h, lookup.bias, forgiven);
  float nearest = plane;
  uint weight = 0;
  for (uint e = 0; e < own.layers; ++e) {
    const LayerEntry entry = entries[texel.index * own.layers + e];
    const float off = abs(entry.t - plane);
    if (entry.weight == 0 || off > own.epsilon * plane + forgiven + entry.reach || off > nearest) continue;
    nearest = off;
    weight = entry.weight;
  }
  return weight;
}

float visibility_of(LightView view, vec3 d, vec3 m) {
  const float h = dot(m, d), above = share_above(d, m);
  const Texel texel = locate(view, 0, lookup.size, d);
  uint weight = weight_in(texel, m, h);
  if (weight == 0 && own.neighbours != 0 && texel.index != kNoTexel) {
    for (int k = 0; k < 9; ++k) {
      const vec3 to = texel.direction + float(k % 3 - 1) * texel.across[0] + float(k / 3 - 1) * texel.across[1];
      if (to.z * d.z <= 0.0) continue;  // beyond the light's plane
      weight = max(weight, weight_in(locate(view, 0, lookup.size, texel.along * to), m, h));
    }
  }
  return min(above, float(weight) / own.total);
}

#include "maps/host/scalar_main.glsl"
