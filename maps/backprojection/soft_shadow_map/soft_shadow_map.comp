// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/backprojection/soft_shadow_map/soft_shadow_map.shared.h"
#define OWN_PUSH SoftLookupPush
#include "maps/host/look_up.glsl"

// Looks up the soft shadow map at the view samples: V of the receiver's texel, or bilinear between the four texels
// whose centres are around the sample. Pixels on occluders are marked by a 1 in their result: they have no soft shadow,
// and see all of the light above their horizon. Texels without a receiver are lit, as are samples outside the map.

layout(scalar, binding = 4) readonly buffer Visible { float visible[]; };
#define LIGHT_TABLE 5
#include "maps/backprojection/light_table.glsl"

float texel_of(ivec2 at, uint first) {
  const ivec2 within = clamp(at, ivec2(0), ivec2(int(own.size) - 1));
  return visible[first + uint(within.y) * own.size + uint(within.x)];
}

float soft_shadow(vec3 d, SideView side) {
  if (side.face_count == 0) return 1.0;
  const uint first = side.first_face * own.size * own.size;
  const vec2 place = (d.xy / abs(d.z) - side.lower) / (side.upper - side.lower) * float(own.size);
  if (any(lessThan(place, vec2(0.0))) || any(greaterThan(place, vec2(float(own.size))))) return 1.0;
  if (own.linear == 0) return texel_of(ivec2(floor(place)), first);
  const vec2 base = floor(place - 0.5), part = place - 0.5 - base;
  const ivec2 at = ivec2(base);
  const float a = texel_of(at, first), b = texel_of(at + ivec2(1, 0), first);
  const float c = texel_of(at + ivec2(0, 1), first), e = texel_of(at + ivec2(1, 1), first);
  const float low = a + part.x * (b - a), high = c + part.x * (e - c);
  return clamp(low + part.y * (high - low), 0.0, 1.0);
}

void main() {
  const uint i = this_receiver();
  if (i >= lookup.receiver_count) return;
  const Receiver receiver = receivers[lookup.first_receiver + i];
  const bool on_occluder = results[lookup.first_result + i] != 0;
  float v = 1.0;
  if (receiver.n != vec3(0.0)) {
    const vec3 d = to_basis(lookup.basis, receiver.p - views[0].point), m = -to_basis(lookup.basis, receiver.n);
    if (!on_emitting_side(d)) {
      v = 0.0;
    } else {
      v = light_above_horizon(vec3(d.xy, abs(d.z)), d.z < 0.0 ? vec3(m.xy, -m.z) : m);
      if (!on_occluder) v = visible_above(soft_shadow(d, views[0].side[d.z < 0.0 ? 1 : 0]), v);
    }
  }
  results[lookup.first_result + i] = floatBitsToUint(v);
}
