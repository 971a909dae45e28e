// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "render/group_order.glsl"

// Stores the number of each workgroup, in the order of launch, and counts how often each number occurs.

layout(local_size_x = 1) in;
layout(scalar, binding = 0) buffer Numbers { uint number_of[]; };
layout(scalar, binding = 1) buffer Counts { uint counts[]; };

void main() {
  const uint launched = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x, number = group_in_turn();
  if (launched < number_of.length()) number_of[launched] = number;
  if (number < counts.length()) atomicAdd(counts[number], 1);
}
