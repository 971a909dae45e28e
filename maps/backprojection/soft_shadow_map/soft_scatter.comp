// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/backprojection/soft_shadow_map/soft_shadow_map.shared.h"

// Computes the sums of Atty et al. 2006 by scattering, as published: each occluder texel adds itself to all texels of
// the receivers' map reached by its penumbra. At depth z_P an occluder shades directions within the light times (1/z_P
// - 1/z) of its own direction; this extent grows with the receiver's depth z, so the deepest receiver bounds it. Sums
// are integers (soft_patch.glsl), so the order of additions does not matter.

layout(local_size_x = kLookupGroup) in;
layout(scalar, binding = 0) readonly buffer Occluders { float occluders[]; };
layout(scalar, binding = 1) readonly buffer ReceiverMap { float receiver_map[]; };
layout(scalar, binding = 2) buffer Sums { uvec2 sums[]; };  // of each receiver texel: low word, high word
layout(scalar, binding = 3) buffer Counters { uint counters[]; };
layout(scalar, push_constant) uniform Push { SoftMapPush push; };
#define LIGHT_TABLE 4
#include "maps/backprojection/light_table.glsl"
#include "maps/backprojection/soft_shadow_map/soft_patch.glsl"

void main() {
  const uint i = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (i >= push.occluder_size * push.occluder_size) return;
  const float stored = occluders[push.occluder_first + i];
  if (stored >= 1.0 || stored <= 0.0) return;
  const float depth = stored * push.occluder_far;
  const uvec2 texel = uvec2(i % push.occluder_size, i / push.occluder_size);
  const vec2 from = push.occluder_lower + vec2(texel) * push.occluder_texel, to = from + push.occluder_texel;
  const float reach = max(1.0 / depth - 1.0 / push.deepest, 0.0);
  const vec2 end = vec2(float(push.receiver_size));
  ivec2 first = ivec2(clamp(floor((from - push.light_upper * reach - push.receiver_lower) / push.receiver_texel) - 1.0, vec2(0.0), end));
  ivec2 last = ivec2(clamp(ceil((to - push.light_lower * reach - push.receiver_lower) / push.receiver_texel) + 1.0, vec2(0.0), end));
  first.y = max(first.y, int(push.first_row));
  last.y = min(last.y, int(push.last_row));
  uint pairs = 0;
  // One loop: Mesa's driver for processors loses iterations of two nested loops (depth_pyramid.glsl).
  const uvec2 extent = uvec2(max(last - first, ivec2(0)));
  for (uint k = 0; k < extent.x * extent.y; ++k) {
    const uvec2 at = uvec2(first) + uvec2(k % extent.x, k / extent.x);
    const uint place = push.receiver_first + at.y * push.receiver_size + at.x;
    const float z = receiver_map[place];
    const uvec2 more = z >= 1.0 ? uvec2(0) : patch_units(receiver_tangents(at), z * push.receiver_far, texel, depth);
    if (more != uvec2(0)) {
      ++pairs;
      const uint before = atomicAdd(sums[place].x, more.x);
      const uint high = more.y + (before + more.x < before ? 1 : 0);
      if (high != 0) atomicAdd(sums[place].y, high);
    }
  }
  const uint before = atomicAdd(counters[0], pairs);
  if (before + pairs < before) atomicAdd(counters[1], 1);
}
