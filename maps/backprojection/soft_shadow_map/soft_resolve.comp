// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/backprojection/soft_shadow_map/soft_shadow_map.shared.h"

// Converts the sums to V.

layout(local_size_x = kLookupGroup) in;
layout(scalar, binding = 0) readonly buffer Sums { uvec2 sums[]; };
layout(scalar, binding = 1) buffer Visible { float visible[]; };
layout(scalar, push_constant) uniform Push { SoftMapPush push; };
#include "maps/backprojection/soft_shadow_map/soft_units.glsl"

void main() {
  const uint i = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (i >= push.receiver_size * push.receiver_size) return;
  const uint place = push.receiver_first + i;
  const float v = push.half_floats != 0 ? max(1.0 - uintBitsToFloat(sums[place].x), 0.0) : visible_after(sums[place]);
  visible[place] = push.later != 0 ? min(visible[place], v) : v;
}
