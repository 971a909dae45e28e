// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/backprojection/level_maps.shared.h"

// Computes a coarse level of maps: each texel has the nearest depth of 2^level x 2^level texels, and the box around its
// non-empty texels: first and last column, first and last row, eight bits each.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Maps { float maps[]; };
layout(scalar, binding = 1) writeonly buffer Levels { uvec2 levels[]; };  // bits of the depth, and the box
layout(scalar, push_constant) uniform Push { LevelPush push; };

void main() {
  const uint side = ((push.size - 1) >> push.level) + 1;
  const uint i = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * 64 + gl_LocalInvocationID.x;
  if (i >= push.maps * side * side) return;
  const uint map = i / (side * side);
  const uvec2 first = uvec2(i % side, i / side % side) << push.level;
  const uvec2 last = min(first + (1u << push.level), uvec2(push.size)) - 1;
  float nearest = 1.0;
  uvec2 lower = uvec2(255), upper = uvec2(0);
  for (uint y = first.y; y <= last.y; ++y) {
    for (uint x = first.x; x <= last.x; ++x) {
      const float depth = maps[(map * push.size + y) * push.size + x];
      if (depth >= 1.0) continue;
      nearest = min(nearest, depth);
      lower = min(lower, uvec2(x, y) - first);
      upper = max(upper, uvec2(x, y) - first);
    }
  }
  levels[push.start + i] = uvec2(floatBitsToUint(nearest), lower.x | upper.x << 8 | lower.y << 16 | upper.y << 24);
}
