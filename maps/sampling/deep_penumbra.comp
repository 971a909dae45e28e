// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/sampling/deep_penumbra.shared.h"
#define OWN_PUSH DeepPenumbraPush
#include "maps/host/look_up.glsl"
#include "maps/sampling/texel.glsl"

// Returns V from the receiver's texel (St-Amour, Paquette and Poulin 2005), as a function of depth, at the intersection
// of the receiver's plane with the ray through the texel's centre, less the bias. Nothing is interpolated.

layout(scalar, binding = 4) readonly buffer Lists { uint lists[]; };  // written by PenumbraEvents
layout(scalar, binding = 5) readonly buffer Samples { vec3 samples[]; };
#include "maps/host/share_above.glsl"

float visibility_of(LightView view, vec3 d, vec3 m) {
  const float above = share_above(d, m);
  const Texel texel = locate(view, 0, lookup.size, d);
  if (texel.index == kNoTexel) return above;
  float forgiven;
  const float plane = plane_depth(texel, m, dot(m, d), lookup.bias, forgiven), depth = plane - forgiven;
  // The last step that begins before `depth`.
  const uint texels = lookup.faces * lookup.size * lookup.size;
  uint first = lists[texel.index], last = lists[texel.index + 1];  // the step is among those before `last`
  const uint begin = first;
  while (first < last) {
    const uint middle = (first + last) / 2;
    if (uintBitsToFloat(lists[texels + 1 + 2 * middle]) < depth) first = middle + 1;
    else last = middle;
  }
  return first == begin ? above : min(above, uintBitsToFloat(lists[texels + 1 + 2 * (first - 1) + 1]));
}

#include "maps/host/scalar_main.glsl"
