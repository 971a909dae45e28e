// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/backprojection/soft_shadow_map/soft_shadow_map.shared.h"
#include "render/group_order.glsl"

// Computes the sums of Atty et al. 2006 by gathering: each texel of the receivers' map adds the occluder texels that
// can hide light from it. An occluder between the receiver and the light, and no nearer to the light's plane than
// `nearest`, is seen from the light's centre within the light times (1/nearest - 1/z) of the receiver's direction.

layout(local_size_x = kLookupGroup) in;
layout(scalar, binding = 0) readonly buffer Occluders { float occluders[]; };
layout(scalar, binding = 1) readonly buffer ReceiverMap { float receiver_map[]; };
layout(scalar, binding = 2) buffer Sums { uvec2 sums[]; };  // low word, high word; with 16-bit floats, the bits of
                                                            // their sum
layout(scalar, binding = 3) buffer Counters { uint counters[]; };  // number of pairs that cover light: low word, high
                                                                   // word
layout(scalar, push_constant) uniform Push { SoftMapPush push; };
#define LIGHT_TABLE 4
#include "maps/backprojection/light_table.glsl"
#include "maps/backprojection/soft_shadow_map/soft_patch.glsl"

// Rounds x to the nearest 16-bit float, ties to even; 0 ... 65504.
float to_half(float x) {
  if (x < 1.0 / 16384.0) return roundEven(x * 16777216.0) / 16777216.0;
  uint bits = floatBitsToUint(x);
  bits += 0xfffu + (bits >> 13 & 1u);
  return uintBitsToFloat(bits & ~0x1fffu);
}

void main() {
  const uint i = group_in_turn() * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (i >= push.receiver_size * push.receiver_size) return;
  const uint result = push.receiver_first + i;
  const float stored = receiver_map[result];
  if (stored >= 1.0) return;
  const float z = stored * push.receiver_far;
  const vec2 at = receiver_tangents(uvec2(i % push.receiver_size, i / push.receiver_size));
  const float reach = max(1.0 / push.nearest - 1.0 / z, 0.0);
  const vec2 from = at + push.light_lower * reach, to = at + push.light_upper * reach;
  const vec2 end = vec2(float(push.occluder_size));
  ivec2 first = ivec2(clamp(floor((from - push.occluder_lower) / push.occluder_texel) - 1.0, vec2(0.0), end));
  ivec2 last = ivec2(clamp(ceil((to - push.occluder_lower) / push.occluder_texel) + 1.0, vec2(0.0), end));
  first.y = max(first.y, int(push.first_row));
  last.y = min(last.y, int(push.last_row));
  uvec2 sum = sums[result];
  float blended = uintBitsToFloat(sum.x);
  uint pairs = 0;
  // Row by row, in one loop: Mesa's driver for processors loses iterations of two nested loops (depth_pyramid.glsl).
  const uvec2 extent = uvec2(max(last - first, ivec2(0)));
  for (uint k = 0; k < extent.x * extent.y; ++k) {
    const uvec2 texel = uvec2(first) + uvec2(k % extent.x, k / extent.x);
    const float depth = occluders[push.occluder_first + texel.y * push.occluder_size + texel.x];
    const uvec2 more = depth >= 1.0 || depth <= 0.0 ? uvec2(0) : patch_units(at, z, texel, depth * push.occluder_far);
    if (more != uvec2(0)) {
      ++pairs;
      if (push.half_floats != 0) {
        blended = to_half(blended + to_half(share_of(more)));
      } else {
        uint carry;
        sum.x = uaddCarry(sum.x, more.x, carry);
        sum.y += more.y + carry;
      }
    }
  }
  sums[result] = push.half_floats != 0 ? uvec2(floatBitsToUint(blended), 0) : sum;
  const uint before = atomicAdd(counters[0], pairs);
  if (before + pairs < before) atomicAdd(counters[1], 1);
}
