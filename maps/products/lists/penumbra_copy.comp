// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/products/lists/penumbra_events.shared.h"

// Copies the steps of each texel to the beginning of its list.

layout(local_size_x = kLookupGroup) in;
layout(scalar, binding = 0) readonly buffer Steps { uvec2 steps[]; };
layout(scalar, binding = 1) readonly buffer Counts { uint counts[]; };
layout(scalar, binding = 2) readonly buffer Offsets { uint offsets[]; };
layout(scalar, binding = 3) buffer Lists { uvec2 lists[]; };
layout(scalar, push_constant) uniform Push { CopyStepsPush push; };

void main() {
  const uint texel = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (texel >= push.texel_count) return;
  for (uint k = 0; k < counts[texel]; ++k) lists[offsets[texel] + k] = steps[texel * push.capacity + k];
}
