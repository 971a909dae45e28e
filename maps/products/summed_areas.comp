// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/products/summed_areas.shared.h"

// Computes summed-area tables (Crow 1984): running sums along rows, then along columns, in place. Unsigned integers:
// sums are exact modulo 2^32, in any order. One invocation for each line.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) buffer Images { uint images[]; };
layout(scalar, push_constant) uniform Push { SummedAreasPush push; };

void main() {
  const uint line = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x +
                    gl_LocalInvocationID.x;
  if (line >= push.lines) return;
  const uint image = line / push.size, place = line % push.size;
  const uint first = image * push.size * push.size + (push.columns != 0 ? place : place * push.size);
  const uint step = push.columns != 0 ? push.size : 1;
  uint sum = 0;
  for (uint i = 0; i < push.size; ++i) {
    const uint at = first + i * step;
    sum += images[at];
    images[at] = sum;
  }
}
