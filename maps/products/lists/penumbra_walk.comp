// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/products/lists/penumbra_events.shared.h"

// Traverses the maps of light samples along the ray from the light's centre through the centre of each of its texels
// (St-Amour, Paquette and Poulin 2005). An event is recorded where the ray passes behind, or out from behind, the
// surface of a sample's map. One invocation for each texel, samples in their order.
//
// On a face of a sample's map with axes a, b across and w along, the ray's point at t is O + t D, and the ray crosses
// the texel's border at coordinate c where (O.a - c O.w) + t (D.a - c D.w) = 0. Along the ray a/w changes in one
// direction alone, the sign of D.a O.w - O.a D.w: so every texel is left by one of two sides.

layout(local_size_x = kLookupGroup) in;
layout(scalar, binding = 0) readonly buffer Centre { LightView centre; };
layout(scalar, binding = 1) readonly buffer Views { LightView views[]; };
layout(scalar, binding = 2) readonly buffer Maps { float maps[]; };
layout(scalar, binding = 3) readonly buffer Weights { uint weights[]; };
layout(scalar, binding = 4) buffer Events { uvec2 events[]; };  // bits of t; weight, and in the highest bit 1 for an
                                                                // event into shadow
layout(scalar, binding = 5) buffer Counts { uint counts[]; };   // of each texel; events beyond the capacity are not
                                                                // stored
layout(scalar, binding = 6) buffer Most { uint most; };
layout(scalar, binding = 7) readonly buffer Nearest { float nearest_of[]; };  // smallest depth in each sample's maps
layout(scalar, push_constant) uniform Push { EventsPush push; };

uint texel, count;

void add_event(float t, bool into_shadow, uint weight) {
  if (count < push.capacity) {
    events[texel * push.capacity + count] = uvec2(floatBitsToUint(t), weight | (into_shadow ? 0x80000000u : 0u));
  }
  ++count;
}

// Converts to coordinates on face k of a side: across, across, along (face_of in map_fit.cpp).
vec3 on_face(vec3 e, uint k) {
  if (k == 0) return e;
  if (k == 1) return vec3(e.y, e.z, e.x);
  if (k == 2) return vec3(e.y, e.z, -e.x);
  if (k == 3) return vec3(e.x, e.z, e.y);
  return vec3(e.x, e.z, -e.y);
}

// Clips first ... last to the values of t with x0 + t x1 >= 0.
void clip(float x0, float x1, inout float first, inout float last) {
  if (x1 > 0.0) first = max(first, -x0 / x1);
  else if (x1 < 0.0) last = min(last, -x0 / x1);
  else if (x0 < 0.0) last = first;
}

// Returns the t at which the ray leaves the column (or row) of texels at its border c, from `from` on; `last`, the end
// of the face, if the ray is still on this side of the border there. The sign at the end decides, because t itself is
// ambiguous: on a sideways face the ray may come from behind the sample, and borders that it never reaches then have an
// earlier t.
float crossing(float o, float d, float ow, float dw, float c, float from, float last, bool grows) {
  const float here = o - c * ow, slope = d - c * dw, end = here + last * slope;
  if (grows ? !(end > 0.0) : !(end < 0.0)) return last;
  return clamp(-here / slope, from, last);
}

// Traverses one face, from where the ray may be behind the nearest surface of the sample's maps, at depth `least`. o, d:
// the ray on the face.
void walk(vec3 o, vec3 d, vec2 lower, vec2 upper, uint map, float far, float nearest, float farthest, float least, uint weight) {
  float t = d.z > 0.0 ? max(nearest, (least - o.z) / d.z) : nearest, last = farthest;
  clip(o.z, d.z, t, last);
  clip(o.x - lower.x * o.z, d.x - lower.x * d.z, t, last);
  clip(upper.x * o.z - o.x, upper.x * d.z - d.x, t, last);
  clip(o.y - lower.y * o.z, d.y - lower.y * d.z, t, last);
  clip(upper.y * o.z - o.y, upper.y * d.z - d.y, t, last);
  if (!(t < last)) return;

  const vec2 width = (upper - lower) / float(push.size);
  const vec2 turn = vec2(d.x * o.z - o.x * d.z, d.y * o.z - o.y * d.z);
  // First texel: that of a position slightly behind the entry, since the entry itself lies on a border. A texel of
  // which less than 1e-4 of t is crossed may be skipped.
  const float within = t + min(1e-4 * t, 0.5 * (last - t));
  const vec3 entry = o + within * d;
  ivec2 at = clamp(ivec2(floor((entry.xy / entry.z - lower) / width)), ivec2(0), ivec2(push.size - 1));
  bool shadow = false;
  for (uint step = 0; step < 2 * push.size + 2; ++step) {
    const vec2 next = lower + (vec2(at) + vec2(turn.x > 0.0 ? 1.0 : 0.0, turn.y > 0.0 ? 1.0 : 0.0)) * width;
    const float tx = turn.x == 0.0 ? last : crossing(o.x, d.x, o.z, d.z, next.x, t, last, turn.x > 0.0);
    const float ty = turn.y == 0.0 ? last : crossing(o.y, d.y, o.z, d.z, next.y, t, last, turn.y > 0.0);
    const float leave = min(min(tx, ty), last);
    const float depth = far * maps[(map * push.size + uint(at.y)) * push.size + uint(at.x)];
    // Tests whether the ray is behind the map's surface.
    const bool enters_behind = o.z + t * d.z > depth, leaves_behind = o.z + leave * d.z > depth;
    if (enters_behind != shadow) add_event(t, enters_behind, weight);
    if (leaves_behind != enters_behind) add_event(clamp((depth - o.z) / d.z, t, leave), leaves_behind, weight);
    shadow = leaves_behind;
    t = leave;
    if (leave >= last) break;
    if (tx <= ty) at.x += turn.x > 0.0 ? 1 : -1;
    else at.y += turn.y > 0.0 ? 1 : -1;
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(push.size)))) break;
  }
  // the ray continues on the sample's other faces, or beyond the last receiver
  if (shadow && t < farthest) add_event(t, false, weight);
}

void main() {
  texel = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (texel >= push.texel_count) return;
  const uint index = push.first_texel + texel, row = index / push.size, face = row / push.size;
  const uint s = face >= centre.side[0].first_face + centre.side[0].face_count ? 1 : 0;
  const SideView side = centre.side[s];
  const bool window = side.face_count == 1;
  const uint k = face - side.first_face;
  const vec2 lower = window ? side.lower : vec2(-1.0, k == 0 ? -1.0 : 0.0), upper = window ? side.upper : vec2(1.0);
  const vec2 at = lower + (vec2(index % push.size, row % push.size) + 0.5) * ((upper - lower) / float(push.size));
  // Direction of the ray with z on its side of the light's plane, of length one along the face.
  vec3 e = vec3(at, 1.0);
  if (k == 1 || k == 2) e = vec3(k == 1 ? 1.0 : -1.0, at);
  if (k == 3 || k == 4) e = vec3(at.x, k == 3 ? 1.0 : -1.0, at.y);
  const float mirrored = s == 0 ? 1.0 : -1.0;

  count = push.first_point == 0 ? 0 : counts[texel];
  const float nearest = (s == 0 ? push.nearest.x : push.nearest.y) / e.z, farthest = centre.far;
  for (uint j = 0; j < push.point_count; ++j) {
    const LightView view = views[push.first_point + j];
    const vec3 offset = centre.point - view.point;
    const vec3 o = vec3(dot(push.basis.u, offset), dot(push.basis.v, offset), mirrored * dot(push.basis.n, offset));
    const SideView own = view.side[s];
    // The margin exceeds the rounding of the ray's position at this depth, however near the surface is to the light.
    const float least = 0.999 * view.far * nearest_of[push.first_point + j] - 1e-5 * (abs(o.x) + abs(o.y) + abs(o.z));
    for (uint f = 0; f < own.face_count; ++f) {
      const bool own_window = own.face_count == 1;
      const vec2 own_lower = own_window ? own.lower : vec2(-1.0, f == 0 ? -1.0 : 0.0);
      const vec2 own_upper = own_window ? own.upper : vec2(1.0);
      walk(on_face(o, f), on_face(e, f), own_lower, own_upper, push.first_map + j * push.sample_faces + own.first_face + f, view.far, nearest,
           farthest, least, weights[push.first_point + j]);
    }
  }
  counts[texel] = count;
  atomicMax(most, count);
}
