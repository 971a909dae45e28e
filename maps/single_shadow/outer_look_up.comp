// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/single_shadow/outer_look_up.shared.h"
#define OWN_PUSH OuterLookUpPush
#include "maps/host/look_up.glsl"
#include "maps/single_shadow/falloff.glsl"

// Returns V (Wyman and Hansen 2003, Chan and Durand 2003): 0 where the shadow map gives shadow; else the value of the
// second map.

layout(scalar, binding = 4) readonly buffer Outer { uvec2 outer[]; };

// Returns V from one texel of the face that contains the receiver's direction.
float light_of(LightView view, MapFace face, uvec2 cell, vec3 d, vec3 m, float along) {
  Tap tap = tap_of(view, lookup.size, face, cell);
  tap.along = along;
  tap.mirrored = d.z < 0.0 ? -1.0 : 1.0;
  tap.direction.z *= tap.mirrored;
  const bool shaded = lookup.own_depth != 0 ? is_before_depth(tap, along, lookup.bias)
                                            : blocks(tap, m, dot(m, d), along * (1.0 + kSteepest * tap.texel), lookup.bias);
  if (shaded) return 0.0;
  const uvec2 found = outer[(face.map * lookup.size + cell.y) * lookup.size + cell.x];
  if (own.smoothies != 0 && !(uintBitsToFloat(found.y) < abs(d.z))) return 1.0;
  return light_at(own.falloff, uintBitsToFloat(found.x));
}

float visibility_of(LightView view, vec3 d, vec3 m) {
  if (!(dot(m, d) > 0.0)) return 0.0;  // the light's centre is below the receiver's horizon
  const SideView side = view.side[d.z < 0.0 ? 1 : 0];
  if (side.face_count == 0) return 1.0;
  const FaceHit hit = face_hit(view, d);
  const MapFace face = face_of(side, 0, lookup.size, hit.face);
  const vec2 at = (hit.f.xy / hit.f.z - face.lower) / face.texel, most = vec2(float(lookup.size - 1));
  if (own.linear == 0) return light_of(view, face, uvec2(clamp(floor(at), vec2(0.0), most)), d, m, hit.f.z);
  const vec2 first = floor(at - 0.5), share = at - 0.5 - first;
  float v[4];
  for (int k = 0; k < 4; ++k) {
    const vec2 cell = clamp(first + vec2(k & 1, k >> 1), vec2(0.0), most);
    v[k] = light_of(view, face, uvec2(cell), d, m, hit.f.z);
  }
  // This form is exact where all four values are equal.
  const float lower = v[0] + (v[1] - v[0]) * share.x, upper = v[2] + (v[3] - v[2]) * share.x;
  return clamp(lower + (upper - lower) * share.y, 0.0, 1.0);
}

#include "maps/host/scalar_main.glsl"
