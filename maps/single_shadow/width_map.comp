// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/single_shadow/width_map.shared.h"

// Computes the distance of each black texel (an occluder's) from the nearest white one (Kirsch and Doellner 2003). The
// paper filters a picture repeatedly, one texel farther each time. Here a first pass computes distances along rows; a
// second pass combines each of these with the distance down the column, and keeps the least root of the sum of their
// squares, which is the exact Euclidean distance. The outside of a face is not white.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Occluders { float occluders[]; };  // depths; 1 for empty texels
layout(scalar, binding = 1) buffer Rows { float rows[]; };                     // distance to white along the row
layout(scalar, binding = 2) buffer Widths { float widths[]; };
layout(scalar, push_constant) uniform Push { WidthMapPush push; };

const float kNone = 1e30;  // no white texel within the radius

void main() {
  const uint i = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (i >= push.size * push.size) return;
  const ivec2 cell = ivec2(i % push.size, i / push.size);
  const int most = int(push.radius), side = int(push.size);
  float least = kNone;
  if (push.down == 0) {
    for (int k = 0; k <= most; ++k) {
      const ivec2 at = cell.x + ivec2(-k, k);
      const bool left = at.x >= 0 && occluders[push.first + cell.y * side + at.x] >= 1.0;
      const bool right = at.y < side && occluders[push.first + cell.y * side + at.y] >= 1.0;
      if (left || right) {
        least = float(k) * push.texel.x;
        break;
      }
    }
    rows[push.first + i] = least;
    return;
  }
  for (int k = -most; k <= most; ++k) {
    const int y = cell.y + k;
    if (y < 0 || y >= side) continue;
    const float along = rows[push.first + y * side + cell.x], across = float(k) * push.texel.y;
    if (along < kNone) least = min(least, sqrt(along * along + across * across));
  }
  widths[push.first + i] = least;
}
