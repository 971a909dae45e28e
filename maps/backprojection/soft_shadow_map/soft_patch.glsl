// SPDX-License-Identifier: Apache-2.0
#include "maps/backprojection/soft_shadow_map/soft_units.glsl"

// Coverage of the light by one occluder texel, for one receiver texel, in both forms of soft-shadow-map (Atty et al.
// 2006, section 3.4): the texel is a rectangle parallel to the light at its own depth; seen from the receiver, the
// rectangle covers a part of the light. Included after soft_shadow_map.shared.h, the push constants `push`, the buffer
// `occluders` and light_table.glsl.

// Returns positions on an axis of the light, from one side to the other, in units of 2^-20: neighbours at one depth
// have the same border, so that their covered parts add up without remainder.
uvec2 places(vec2 x) { return uvec2(clamp(x / (push.light_upper - push.light_lower) + 0.5, 0.0, 1.0) * 1048576.0 + 0.5); }

// Returns the depth at which receivers begin to be in a texel's shadow (begins_behind of taps.glsl, whose bias grows
// with the slope; here the bias is constant, since the map of receivers has no slopes).
float begins_behind(float depth, uint place, float forgiven) {
  if (push.depth_use == kDepthFirst) return depth + forgiven;
  const float second = push.occluder_far * occluders[push.second_first + place];
  const bool single = second >= push.occluder_far;
  if (push.depth_use == kDepthSecond) return single ? 4.0 * push.occluder_far : second;
  if (single) return depth + forgiven;
  const float middle = depth + 0.5 * (second - depth);
  return push.depth_use == kDepthMidpoint ? middle : min(depth + forgiven, middle);
}

// Returns the part of the light covered by the texel at `depth`, seen from the receiver texel with tangents `at` and
// depth z, in units of 2^-40 of the light, low and high word. Returns 0 if the texel is not in front of the receiver.
uvec2 patch_units(vec2 at, float z, uvec2 texel, float depth) {
  const float width = max(push.occluder_texel.x, push.occluder_texel.y);
  if (!(begins_behind(depth, texel.y * push.occluder_size + texel.x, push.bias * width * z) < z) || !(depth < z)) {
    return uvec2(0);
  }
  // precise: the same bits in every shader.
  precise const float to_light = depth * z / (z - depth);
  precise const vec2 from = push.occluder_lower + vec2(texel) * push.occluder_texel;
  precise const vec2 to = push.occluder_lower + vec2(texel + 1) * push.occluder_texel;
  precise const vec2 a = (from - at) * to_light, b = (to - at) * to_light;
  if (push.upright == 0) {  // any other shape, and textures: fractions in units of 2^-30
    const uint share = light_between(a, b);
    return uvec2(share << 10, share >> 22);
  }
  const uvec2 extent = places(b) - places(a);
  uint high, low;
  umulExtended(extent.x, extent.y, high, low);
  return uvec2(low, high);
}

vec2 receiver_tangents(uvec2 texel) {
  precise const vec2 at = push.receiver_lower + (vec2(texel) + 0.5) * push.receiver_texel;
  return at;
}
