// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/products/lists/penumbra_events.shared.h"

// Finds the smallest depth in the maps of each light sample: nothing hides a ray that is nearer. One invocation for each
// row of texels.

layout(local_size_x = kLookupGroup) in;
layout(scalar, binding = 0) readonly buffer Maps { float maps[]; };
layout(scalar, binding = 1) buffer Nearest { uint nearest[]; };  // for each sample: the bits of a depth, at first all
                                                                 // ones
layout(scalar, push_constant) uniform Push { NearestDepthsPush push; };

void main() {
  const uint row = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  const uint rows = push.sample_faces * push.size;  // of a sample
  if (row >= push.point_count * rows) return;
  const uint first = (push.first_map * push.size + row) * push.size;
  float least = maps[first];
  for (uint i = 1; i < push.size; ++i) least = min(least, maps[first + i]);
  atomicMin(nearest[push.first_point + row / rows], floatBitsToUint(least));  // depths are positive: their bits have
                                                                              // their order
}
